//! Damaged files are errors or pictures, never panics.

use tenfold_image::{ExrPixels, Format, Image, PngDepth, WriteOptions};

const ROUNDS: usize = 400;

/// A small generator (SplitMix64), so that the cases are the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

fn samples() -> Vec<(Format, Vec<u8>)> {
    let pixel = |x, y| [x as f32 / 19.0, y as f32 / 13.0, 0.5];
    let image = Image::from_fn(19, 13, ["R", "G", "B"], pixel).unwrap();
    let codes: Vec<u8> = (0..19 * 13 * 3).map(|i| (i * 5) as u8).collect();
    let encode = |format, options| (format, image.to_bytes(format, &options).unwrap());
    let plain = WriteOptions::default();
    let kind = image::ExtendedColorType::Rgb8;
    let (mut jpeg, mut bmp, mut tga) = (Vec::new(), Vec::new(), Vec::new());
    image::codecs::jpeg::JpegEncoder::new(&mut jpeg).encode(&codes, 19, 13, kind).unwrap();
    image::codecs::bmp::BmpEncoder::new(&mut bmp).encode(&codes, 19, 13, kind).unwrap();
    image::codecs::tga::TgaEncoder::new(&mut tga).encode(&codes, 19, 13, kind).unwrap();
    vec![
        encode(Format::Exr, plain),
        encode(Format::Exr, WriteOptions { exr_pixels: ExrPixels::Half, ..plain }),
        encode(Format::Png, plain),
        encode(Format::Png, WriteOptions { png_depth: PngDepth::Sixteen, ..plain }),
        encode(Format::Hdr, plain),
        encode(Format::Pfm, plain),
        (Format::Jpeg, jpeg),
        (Format::Bmp, bmp),
        (Format::Tga, tga),
    ]
}

#[test]
fn truncated_files_are_errors() {
    for (format, bytes) in samples() {
        for length in 0..bytes.len() {
            let result = Image::read_bytes(&bytes[..length], Some(format), None);
            // Some decoders make do without a trailer, and JPEG without the last rows.
            if length < bytes.len() / 4 {
                assert!(result.is_err(), "{format} of {length} bytes");
            }
        }
    }
}

#[test]
fn changed_bytes_do_not_panic() {
    let mut random = Random(1);
    let mut readable = 0;
    for (format, bytes) in samples() {
        for _ in 0..ROUNDS {
            let mut damaged = bytes.clone();
            for _ in 0..1 + random.below(4) {
                // Headers deserve more attention than pixels.
                let limit = if random.below(2) == 0 { damaged.len() } else { damaged.len().min(400) };
                let at = random.below(limit);
                damaged[at] = match random.below(4) {
                    0 => 0,
                    1 => 0xff,
                    _ => random.next() as u8,
                };
            }
            readable += usize::from(Image::read_bytes(&damaged, Some(format), None).is_ok());
        }
    }
    assert!(readable > 0);
}

#[test]
fn random_bytes_do_not_panic() {
    let mut random = Random(2);
    for (format, bytes) in samples() {
        for _ in 0..ROUNDS {
            // A true beginning, then noise.
            let kept = random.below(bytes.len().min(64));
            let noise = random.below(300);
            let mut content = bytes[..kept].to_vec();
            content.extend((0..noise).map(|_| random.next() as u8));
            let _ = Image::read_bytes(&content, Some(format), None);
        }
    }
}

#[test]
fn claims_of_enormous_sizes_are_refused() {
    let pfm = b"PF\n1000000000 1000000000\n-1\n0000";
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n0000";
    for bytes in [&pfm[..], hdr] {
        let e = Image::read_bytes(bytes, None, None).unwrap_err();
        assert!(e.to_string().contains("claims"), "{e}");
    }
}
