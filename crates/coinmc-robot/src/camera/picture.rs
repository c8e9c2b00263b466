//! Pictures of the simulated camera: one for every face, as small PNG files (ISO/IEC 15948).

use crate::Face;

/// Width and height, pixels.
const SIDE: u8 = 48;

/// The picture of a coin that shows `face`, `None` for an unreadable picture. No two pictures of a
/// real camera are equal: `grain` stands for the noise that makes them differ.
pub(super) fn picture(face: Option<Face>, grain: &str) -> Vec<u8> {
    let mut file = drawn(face);
    let text = [b"Comment\0", grain.as_bytes()].concat();
    chunk(&mut file, *b"tEXt", &text);
    chunk(&mut file, *b"IEND", &[]);
    file
}

/// The picture without its grain and end.
fn drawn(face: Option<Face>) -> Vec<u8> {
    let mut rows = Vec::new();
    for y in 0..SIDE {
        rows.push(0); // filter: none
        rows.extend((0..SIDE).map(|x| grey(face, x, y)));
    }
    png(SIDE.into(), SIDE.into(), &rows)
}

/// The face in a picture made by [`picture`]; `None` for any other.
pub(super) fn shown(bytes: &[u8]) -> Option<Face> {
    Face::ALL
        .into_iter()
        .find(|face| bytes.starts_with(&drawn(Some(*face))))
}

/// Grey value of a pixel, on a dark table: a bright disc for heads, one with a hole for tails, a
/// bar for the side.
fn grey(face: Option<Face>, x: u8, y: u8) -> u8 {
    const TABLE: u8 = 40;
    let centre = i32::from(SIDE) / 2;
    let (x, y) = (i32::from(x) - centre, i32::from(y) - centre);
    let distance2 = x * x + y * y;
    let coin = match face {
        Some(Face::Heads) => distance2 < 20 * 20,
        Some(Face::Tails) => distance2 < 20 * 20 && distance2 > 8 * 8,
        Some(Face::Side) => x.abs() < 20 && y.abs() < 6,
        None => false,
    };
    if coin { 220 } else { TABLE }
}

/// A greyscale PNG with uncompressed data, up to its end.
fn png(width: u32, height: u32, rows: &[u8]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([8, 0, 0, 0, 0]); // 8 bits, grey, deflate, no filter method, no interlace
    chunk(&mut file, *b"IHDR", &header);
    chunk(&mut file, *b"IDAT", &zlib(rows));
    file
}

fn chunk(file: &mut Vec<u8>, kind: [u8; 4], data: &[u8]) {
    let length = u32::try_from(data.len()).unwrap_or(u32::MAX);
    file.extend(length.to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(data);
    let crc = crc32fast::hash(&file[start..]);
    file.extend(crc.to_be_bytes());
}

/// A zlib stream (RFC 1950) of one stored block (RFC 1951): at most 65 535 bytes.
fn zlib(data: &[u8]) -> Vec<u8> {
    let length = u16::try_from(data.len()).expect("the pictures are small");
    let mut stream = vec![0x78, 0x01, 1];
    stream.extend(length.to_le_bytes());
    stream.extend((!length).to_le_bytes());
    stream.extend(data);
    stream.extend(adler32(data).to_be_bytes());
    stream
}

fn adler32(data: &[u8]) -> u32 {
    let (a, b) = data.iter().fold((1, 0), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (b + a) % 65_521)
    });
    b << 16 | a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_is_recognised_and_nothing_else_is() {
        for face in Face::ALL {
            assert_eq!(shown(&picture(Some(face), "1")), Some(face));
        }
        assert_eq!(shown(&picture(None, "2")), None);
        assert_eq!(shown(b""), None);
    }

    #[test]
    fn checksums_match_known_values() {
        assert_eq!(adler32(b"Wikipedia"), 0x11E6_0398);
        // the end chunk of every PNG file
        assert!(picture(None, "").ends_with(b"\0\0\0\0IEND\xae\x42\x60\x82"));
    }
}
