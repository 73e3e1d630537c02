//! Round trips through every file format.

use std::collections::BTreeMap;
use tenfold_image::{
    Attribute, ColorEncoding, ExrPixels, Format, Image, ImageErrorKind, PixelData, PngDepth, Window,
    WriteOptions,
};
use tenfold_math::Vec2;
use tenfold_math::ops;

/// Values from dark to far above one, different from pixel to pixel and channel to channel.
fn picture(width: u32, height: u32) -> Image {
    Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
        let v = |s: u32| ((x * 31 + y * 17 + s * 71) % 97) as f32;
        [v(0) * 0.013, v(1) * v(1) * 0.01, 1.0 / (1.0 + v(2))]
    })
    .unwrap()
}

fn options(exr_pixels: ExrPixels, png_depth: PngDepth) -> WriteOptions {
    WriteOptions { exr_pixels, png_depth }
}

fn round_trip(image: &Image, format: Format, options: WriteOptions) -> Image {
    let bytes = image.to_bytes(format, &options).unwrap();
    // No hint: what is written must tell its format.
    Image::read_bytes(&bytes, None, None).unwrap()
}

fn worst_relative_error(a: &Image, b: &Image) -> f32 {
    assert_eq!(a.resolution(), b.resolution());
    let mut worst = 0.0_f32;
    for y in 0..a.height() {
        for x in 0..a.width() {
            let (a, b) = (a.rgb(x, y), b.rgb(x, y));
            worst = worst.max((a - b).abs().max_element() / b.max_element());
        }
    }
    worst
}

#[test]
fn floats_survive_exr_and_pfm() {
    for (width, height) in [(1, 1), (37, 29), (3, 100)] {
        let image = picture(width, height);
        let grey = Image::from_fn(width, height, ["Y"], |x, y| [image.get(x, y, 1)]).unwrap();
        for format in [Format::Exr, Format::Pfm] {
            assert_eq!(round_trip(&image, format, WriteOptions::default()), image, "{format}");
            assert_eq!(round_trip(&grey, format, WriteOptions::default()), grey, "{format}");
        }
    }
}

#[test]
fn exr_keeps_infinities_and_nan() {
    let image = Image::from_f32(3, 1, ["Y"], vec![f32::INFINITY, f32::NAN, -1.5]).unwrap();
    for pixels in [ExrPixels::Float, ExrPixels::Half] {
        let back = round_trip(&image, Format::Exr, options(pixels, PngDepth::Eight));
        assert_eq!(back.get(0, 0, 0), f32::INFINITY);
        assert!(back.get(1, 0, 0).is_nan());
        assert_eq!(back.get(2, 0, 0), -1.5);
    }
}

#[test]
fn halves_are_rounded_and_kept_finite() {
    let mut image = picture(20, 10);
    image.set(0, 0, 0, 1e6);
    let back = round_trip(&image, Format::Exr, options(ExrPixels::Half, PngDepth::Eight));
    assert!(matches!(back.data(), PixelData::F16(_)));
    assert_eq!(back.get(0, 0, 0), 65504.0);
    image.set(0, 0, 0, 65504.0);
    assert!(worst_relative_error(&back, &image) < 1.0 / 2048.0);
    // What is a half already stays the same.
    assert_eq!(round_trip(&back, Format::Exr, options(ExrPixels::Half, PngDepth::Eight)), back);
}

#[test]
fn exr_metadata_and_further_channels_survive() {
    let names = ["A", "B", "G", "R", "samples.Y", "stderr.R"];
    let values: Vec<f32> = (0..6 * 4 * 2).map(|i| i as f32 + 100_000.0).collect();
    let mut image = Image::from_f32(4, 2, names, values).unwrap();
    // Display P3.
    let xy = [(0.68, 0.32), (0.265, 0.69), (0.15, 0.06), (0.3127, 0.329)];
    image.metadata.chromaticities = Some(xy.map(|(x, y)| Vec2::new(x, y)));
    image.metadata.origin = (10, -20);
    image.metadata.display_window = Some(Window { x: -1, y: -30, width: 640, height: 480 });
    let text = |s: &str| s.to_owned();
    image.metadata.attributes = BTreeMap::from([
        (text("samplesPerPixel"), Attribute::I32(1024)),
        (text("renderTimeSeconds"), Attribute::F32(12.5)),
        (text("a name that is longer than thirty-one characters"), Attribute::Text(text("é"))),
        (text("software"), Attribute::Text(text("tenfold"))),
        (text("worldToCamera"), Attribute::Matrix(std::array::from_fn(|i| i as f32))),
        (text("history"), Attribute::TextList(vec![text("one"), text("two")])),
    ]);
    for pixels in [ExrPixels::Float, ExrPixels::Half] {
        let back = round_trip(&image, Format::Exr, options(pixels, PngDepth::Eight));
        assert_eq!(back.metadata, image.metadata);
        // Colour comes first, the rest in order.
        assert_eq!(back.channels(), ["R", "G", "B", "A", "samples.Y", "stderr.R"]);
        for y in 0..2 {
            for x in 0..4 {
                // Statistics are floats even where the picture is of halves, for which these values are too large.
                assert_eq!(back.get(x, y, 4), image.get(x, y, 4));
                assert_eq!(back.get(x, y, 5), image.get(x, y, 5));
                let red = if pixels == ExrPixels::Float { image.get(x, y, 3) } else { 65504.0 };
                assert_eq!(back.get(x, y, 0), red);
            }
        }
    }
}

#[test]
fn equal_images_make_equal_exr_files() {
    let mut image = picture(8, 8);
    for i in 0..20 {
        image.metadata.attributes.insert(format!("attribute{i}"), Attribute::I32(i));
    }
    let first = image.to_bytes(Format::Exr, &WriteOptions::default()).unwrap();
    for _ in 0..5 {
        assert_eq!(image.to_bytes(Format::Exr, &WriteOptions::default()).unwrap(), first);
    }
}

#[test]
fn exr_refuses_what_it_cannot_store() {
    let named = |name: &str| {
        let image = Image::from_f32(1, 1, [name], vec![1.0]).unwrap();
        image.to_bytes(Format::Exr, &WriteOptions::default())
    };
    assert!(named("ordinary").is_ok());
    for bad in ["", "\u{4e00}", "a\0b", &"x".repeat(256)] {
        assert!(matches!(named(bad).unwrap_err().kind, ImageErrorKind::Attribute { .. }), "{bad:?}");
    }
    let with = |name: &str, value: Attribute| {
        let mut image = picture(1, 1);
        image.metadata.attributes.insert(name.to_owned(), value);
        image.to_bytes(Format::Exr, &WriteOptions::default())
    };
    let e = with("dataWindow", Attribute::I32(1)).unwrap_err();
    assert!(e.to_string().contains("`dataWindow` cannot be stored"), "{e}");
    assert!(with("compression", Attribute::Text("none".to_owned())).is_err());
    assert!(with("title", Attribute::Text("\u{4e00}".to_owned())).is_err());
}

#[test]
fn hdr_keeps_eight_bits_of_the_brightest_channel() {
    // Narrow pictures are written without run lengths.
    for (width, height) in [(4, 9), (40, 30)] {
        let image = picture(width, height);
        let back = round_trip(&image, Format::Hdr, WriteOptions::default());
        assert!(worst_relative_error(&back, &image) <= 1.0 / 128.0);
        assert_eq!(back.channels(), ["R", "G", "B"]);
    }
    let wild = Image::from_f32(1, 1, ["R", "G", "B"], vec![f32::NAN, -1.0, f32::INFINITY]).unwrap();
    let back = round_trip(&wild, Format::Hdr, WriteOptions::default());
    assert!(back.get(0, 0, 0) == 0.0 && back.get(0, 0, 1) == 0.0 && back.get(0, 0, 2) > 1e37);
}

#[test]
fn eight_bit_codes_survive_png() {
    for names in [&["Y"][..], &["Y", "A"], &["R", "G", "B"], &["R", "G", "B", "A"]] {
        let codes: Vec<u8> = (0..16 * 16 * names.len()).map(|i| (i * 7) as u8).collect();
        let image = Image::from_u8(16, 16, names.iter().copied(), codes, ColorEncoding::Srgb).unwrap();
        assert_eq!(round_trip(&image, Format::Png, WriteOptions::default()), image);
        // As floats they lie on the levels, where the dither leaves them.
        assert_eq!(round_trip(&image.to_f32(), Format::Png, WriteOptions::default()), image);
    }
}

#[test]
fn floats_are_dithered_without_bias() {
    let value = tenfold_image::srgb_to_linear(100.37 / 255.0);
    let image = Image::from_fn(64, 64, ["Y"], |_, _| [value]).unwrap();
    let back = round_trip(&image, Format::Png, WriteOptions::default());
    let PixelData::U8(codes, _) = back.data() else { panic!("not 8 bits") };
    let mean = codes.iter().map(|&c| f64::from(c)).sum::<f64>() / codes.len() as f64;
    assert!((mean - 100.37).abs() < 0.01, "{mean}");
    assert!(codes.iter().all(|c| (100..=101).contains(c)));
}

#[test]
fn sixteen_bit_png_is_nearly_exact() {
    let image = Image::from_fn(64, 4, ["R", "G", "B", "A"], |x, y| {
        [x as f32 / 63.0, y as f32 / 3.0, 0.001, x as f32 / 63.0]
    })
    .unwrap();
    let back = round_trip(&image, Format::Png, options(ExrPixels::Float, PngDepth::Sixteen));
    assert_eq!(back.channels(), image.channels());
    for (a, b) in back.as_f32().unwrap().iter().zip(image.as_f32().unwrap()) {
        // Half a code times the steepest slope of the decoding curve.
        assert!((a - b).abs() <= 0.5 / 65535.0 * 2.5, "{a} {b}");
    }
}

#[test]
fn palettes_and_few_bits_are_expanded() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Two);
    encoder.set_palette(vec![255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9]);
    encoder.set_trns(vec![255, 128]);
    encoder.write_header().unwrap().write_image_data(&[0b00_01_10_11]).unwrap();
    let image = Image::read_bytes(&bytes, None, Some(ColorEncoding::Linear)).unwrap();
    assert_eq!(image.channels(), ["R", "G", "B", "A"]);
    let PixelData::U8(codes, _) = image.data() else { panic!("not 8 bits") };
    assert_eq!(codes, &[255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255, 9, 9, 9, 255]);

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 8, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    encoder.write_header().unwrap().write_image_data(&[0b1010_0001]).unwrap();
    let image = Image::read_bytes(&bytes, None, None).unwrap();
    let values: Vec<f32> = (0..8).map(|x| image.get(x, 0, 0)).collect();
    assert_eq!(values, [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn the_encoding_can_be_overridden() {
    let image = Image::from_u8(1, 1, ["Y"], vec![128], ColorEncoding::Srgb).unwrap();
    let bytes = image.to_bytes(Format::Png, &WriteOptions::default()).unwrap();
    let read = |encoding| Image::read_bytes(&bytes, None, encoding).unwrap().get(0, 0, 0);
    assert_eq!(read(None), tenfold_image::srgb_to_linear(128.0 / 255.0));
    assert_eq!(read(Some(ColorEncoding::Linear)), 128.0 / 255.0);
    assert_eq!(read(Some(ColorEncoding::Gamma(2.0))), ops::powf(128.0_f32 / 255.0, 2.0));
}

#[test]
fn formats_that_are_only_read() {
    let kind = image::ExtendedColorType::Rgb8;
    let rgb: Vec<u8> = (0..16 * 16).flat_map(|i| [200, 100, (i / 16 * 4) as u8]).collect();
    let (mut jpeg, mut bmp, mut tga) = (Vec::new(), Vec::new(), Vec::new());
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 95).encode(&rgb, 16, 16, kind).unwrap();
    image::codecs::bmp::BmpEncoder::new(&mut bmp).encode(&rgb, 16, 16, kind).unwrap();
    image::codecs::tga::TgaEncoder::new(&mut tga).encode(&rgb, 16, 16, kind).unwrap();
    for (bytes, format, tolerance) in [(jpeg, Format::Jpeg, 4), (bmp, Format::Bmp, 0), (tga, Format::Tga, 0)]
    {
        // TGA has no magic number.
        let hint = if format == Format::Tga { Some(format) } else { None };
        let image = Image::read_bytes(&bytes, hint, None).unwrap();
        assert_eq!((image.resolution(), image.channels().len()), ((16, 16), 3));
        let PixelData::U8(codes, _) = image.data() else { panic!("not 8 bits") };
        assert!(codes.iter().zip(&rgb).all(|(a, b)| a.abs_diff(*b) <= tolerance), "{format}");
    }
}

#[test]
fn files_are_written_by_their_suffix_and_read_by_their_content() {
    let directory = tempfile::tempdir().unwrap();
    let image = picture(9, 7);
    for name in ["a.exr", "b.pfm"] {
        let path = directory.path().join(name);
        image.write(&path, &WriteOptions::default()).unwrap();
        assert_eq!(Image::read(&path).unwrap(), image);
    }
    let misnamed = directory.path().join("c.png");
    std::fs::rename(directory.path().join("a.exr"), &misnamed).unwrap();
    assert_eq!(Image::read(&misnamed).unwrap(), image);
    // Nothing else is left behind.
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 2);
}

#[test]
fn faults_name_the_file() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name| picture(1, 1).write(directory.path().join(name), &WriteOptions::default());
    let e = write("x.exe").unwrap_err().to_string();
    assert!(e.ends_with("x.exe: `.exe` is not a known image format (did you mean `.exr`?)"), "{e}");
    let e = write("x.jpg").unwrap_err().to_string();
    assert!(e.contains("only read (expected .exr"), "{e}");
    let e = Image::read(directory.path().join("missing.png")).unwrap_err();
    assert!(matches!(&e.kind, ImageErrorKind::Io(io) if io.kind() == std::io::ErrorKind::NotFound));
    assert!(e.to_string().contains("missing.png: "), "{e}");
    let text = directory.path().join("text.exr");
    std::fs::write(&text, "not an image").unwrap();
    let e = Image::read(&text).unwrap_err().to_string();
    assert!(e.contains("text.exr: damaged EXR file"), "{e}");
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn impossible_windows_are_refused() {
    let with = |origin, display_window| {
        let mut image = picture(2, 2);
        (image.metadata.origin, image.metadata.display_window) = (origin, display_window);
        image.to_bytes(Format::Exr, &WriteOptions::default())
    };
    assert!(with((-5, 5), Some(Window { x: 0, y: 0, width: 10, height: 10 })).is_ok());
    assert!(with((0, 0), Some(Window { x: 0, y: 0, width: u32::MAX, height: 10 })).is_err());
    assert!(with((0, 0), Some(Window { x: i32::MAX, y: 0, width: 10, height: 10 })).is_err());
    assert!(with((0, 0), Some(Window { x: 0, y: 0, width: 0, height: 0 })).is_err());
    assert!(with((i32::MAX, 0), None).is_err());
    assert!(with((0, i32::MIN), None).is_err());
}
