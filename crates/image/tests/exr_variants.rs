//! EXR files as other programs write them: every compression, tiles, several parts, prefixed channels.

use exr::prelude::*;
use std::io::Cursor;
use tenfold_image::{Image as Picture, ImageErrorKind, PixelData};

fn ramp(width: usize, height: usize, scale: f32) -> Vec<f32> {
    (0..width * height).map(|i| (i % 61) as f32 * 0.125 * scale).collect()
}

fn channels(names: &[&str], width: usize, height: usize) -> AnyChannels<FlatSamples> {
    let list = names.iter().zip(1..);
    let list = list.map(|(&name, i)| AnyChannel::new(name, FlatSamples::F32(ramp(width, height, i as f32))));
    AnyChannels::sort(list.collect())
}

fn file(layers: Vec<Layer<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(layers[0].size));
    let image = Image { attributes, layer_data: Layers::from(layers) };
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn layer(name: &str, names: &[&str], encoding: Encoding) -> Layer<AnyChannels<FlatSamples>> {
    let (width, height) = (50, 40);
    Layer::new((width, height), LayerAttributes::named(name), encoding, channels(names, width, height))
}

#[test]
fn every_compression_and_blocking_is_read() {
    use Compression::*;
    let compressions = [
        (Uncompressed, 0.0),
        (RLE, 0.0),
        (ZIP1, 0.0),
        (ZIP16, 0.0),
        (PIZ, 0.0),
        (PXR24, 1e-4),
        // B44 leaves floats alone; DWA is lossy.
        (B44, 0.0),
        (B44A, 0.0),
        (DWAA(None), 0.1),
        (DWAB(None), 0.1),
    ];
    for (compression, tolerance) in compressions {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 16))] {
            let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
            let bytes = file(vec![layer("main", &["R", "G", "B"], encoding)]);
            let image = Picture::read_bytes(&bytes, None, None).unwrap();
            assert_eq!(image.channels(), ["R", "G", "B"]);
            let expected = ramp(50, 40, 2.0);
            for y in 0..40_u32 {
                for x in 0..50_u32 {
                    let (v, e) = (image.get(x, y, 1), expected[(y * 50 + x) as usize]);
                    assert!((v - e).abs() <= tolerance * e.max(1.0), "{compression:?} {blocks:?} {v} {e}");
                }
            }
        }
    }
}

#[test]
fn the_part_with_plain_colour_is_the_main_one() {
    let bytes = file(vec![
        layer("depth", &["Z"], Encoding::SMALL_LOSSLESS),
        layer("beauty", &["R", "G", "B", "A"], Encoding::SMALL_LOSSLESS),
        layer("grey", &["Y"], Encoding::SMALL_LOSSLESS),
    ]);
    let image = Picture::read_bytes(&bytes, None, None).unwrap();
    assert_eq!(image.channels(), ["R", "G", "B", "A"]);
}

#[test]
fn prefixed_colour_is_found() {
    let names = [
        "ViewLayer.Combined.R",
        "ViewLayer.Combined.G",
        "ViewLayer.Combined.B",
        "ViewLayer.Combined.A",
        "ViewLayer.Normal.R",
        "ViewLayer.Normal.G",
        "ViewLayer.Normal.B",
        "ViewLayer.Depth.Z",
    ];
    let bytes = file(vec![layer("main", &names, Encoding::UNCOMPRESSED)]);
    let image = Picture::read_bytes(&bytes, None, None).unwrap();
    assert_eq!(image.channels()[..4], ["R", "G", "B", "A"]);
    assert_eq!(image.channels().len(), 8);
    assert_eq!(image.get(1, 0, 2), 0.125 * 3.0);
}

fn two_by_two(list: Vec<AnyChannel<FlatSamples>>) -> Layer<AnyChannels<FlatSamples>> {
    Layer::new((2, 2), LayerAttributes::default(), Encoding::UNCOMPRESSED, AnyChannels::sort(list.into()))
}

#[test]
fn mixed_kinds_become_floats() {
    let bytes = file(vec![two_by_two(vec![
        AnyChannel::new("Y", FlatSamples::F16(vec![f16::from_f32(0.5); 4])),
        AnyChannel::new("id", FlatSamples::U32(vec![70_000; 4])),
        AnyChannel::new("z", FlatSamples::F32(vec![1e20; 4])),
    ])]);
    let image = Picture::read_bytes(&bytes, None, None).unwrap();
    assert!(matches!(image.data(), PixelData::F32(_)));
    assert_eq!([0, 1, 2].map(|c| image.get(1, 1, c)), [0.5, 70_000.0, 1e20]);
}

#[test]
fn subsampled_channels_are_refused_by_name() {
    let y = AnyChannel::new("Y", FlatSamples::F32(vec![0.0; 4]));
    let mut bytes = file(vec![two_by_two(vec![AnyChannel::new("BY", y.sample_data.clone()), y])]);
    // A channel's entry: name, zero, kind, flags, then the sampling in x and y as integers.
    let at = bytes.windows(3).position(|w| w == b"BY\0").unwrap() + 3 + 4 + 4;
    assert_eq!(bytes[at..at + 8], [1, 0, 0, 0, 1, 0, 0, 0]);
    (bytes[at], bytes[at + 4]) = (2, 2);
    let e = Picture::read_bytes(&bytes, None, None).unwrap_err();
    assert!(matches!(e.kind, ImageErrorKind::Unsupported { .. }), "{e}");
    assert!(e.to_string().contains("BY"), "{e}");
}

#[test]
fn damaged_variants_do_not_panic() {
    use Compression::*;
    // A linear congruential generator (Knuth's MMIX), so that the cases are the same everywhere.
    let mut state = 1_u64;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let mut readable = 0;
    for compression in [Uncompressed, RLE, ZIP1, PIZ, PXR24, B44, B44A, DWAA(None), DWAB(None)] {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 16))] {
            let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
            let one = file(vec![layer("a", &["R", "G", "B"], encoding)]);
            let two = file(vec![layer("a", &["Z"], encoding), layer("b", &["Y"], encoding)]);
            for bytes in [one, two] {
                for _ in 0..ROUNDS {
                    let mut damaged = bytes.clone();
                    for _ in 0..1 + below(4) {
                        // Headers deserve more attention than pixels.
                        let limit = if below(2) == 0 { damaged.len() } else { damaged.len().min(1500) };
                        damaged[below(limit)] = if below(4) == 0 { 0xff } else { below(256) as u8 };
                    }
                    readable += usize::from(Picture::read_bytes(&damaged, None, None).is_ok());
                }
            }
        }
    }
    assert!(readable > 0);
}

const ROUNDS: usize = 100;
