//! 3MF: a zip archive of three files in XML.
//!
//! What readers must find is in the 3MF Core Specification (3MF Consortium, version 1.3) and in the Open
//! Packaging Conventions (ECMA-376, part 2) below it.

use crate::mesh::Mesh;
use crate::stl::millimetres;
use std::fmt::Write as _;
use std::io::{self, BufWriter, Cursor, Seek, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Id="rel0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

/// Writes a mesh as a 3MF package, in millimetres, with a title for people to read. The same mesh and
/// title give the same bytes.
///
/// The object's origin is the coin's centre; the build item moves it to where printers build, with all
/// coordinates positive.
///
/// # Errors
/// Those of `out`.
///
/// # Example
/// ```
/// use coinmc_solid::{Edge, Shape, write_3mf};
/// let shape = Shape::new(0.02, 0.002, Edge::Sharp)?;
/// let mesh = shape.mesh(shape.chord_error_m())?;
/// let mut file = Vec::new();
/// write_3mf(&mesh, "A coin of 20 mm", &mut file)?;
/// assert!(file.starts_with(b"PK"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_3mf(mesh: &Mesh, title: &str, mut out: impl Write) -> io::Result<()> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("[Content_Types].xml", options())?;
    zip.write_all(CONTENT_TYPES.as_bytes())?;
    zip.start_file("_rels/.rels", options())?;
    zip.write_all(RELATIONSHIPS.as_bytes())?;
    zip.start_file("3D/3dmodel.model", options())?;
    write_model(mesh, title, &mut zip)?;
    out.write_all(&zip.finish()?.into_inner())?;
    out.flush()
}

/// Nothing of the time or of the system.
fn options() -> SimpleFileOptions {
    SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(6))
        .last_modified_time(DateTime::DEFAULT)
        .system(System::Unix)
        .unix_permissions(0o644)
}

fn write_model(mesh: &Mesh, title: &str, zip: &mut ZipWriter<impl Write + Seek>) -> io::Result<()> {
    let mut out = BufWriter::new(zip);
    writeln!(
        out,
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <metadata name="Title">{}</metadata>
 <metadata name="Application">coinmc</metadata>
 <resources>
  <object id="1" type="model">
   <mesh>
    <vertices>"#,
        escaped(title)
    )?;
    for [x, y, z] in mesh.vertices().iter().copied().map(millimetres) {
        writeln!(out, r#"     <vertex x="{x}" y="{y}" z="{z}"/>"#)?;
    }
    writeln!(out, "    </vertices>\n    <triangles>")?;
    for [a, b, c] in mesh.triangles() {
        writeln!(out, r#"     <triangle v1="{a}" v2="{b}" v3="{c}"/>"#)?;
    }
    let [x, y, z] = lowest(mesh).map(|x| 0.0 - x);
    writeln!(
        out,
        r#"    </triangles>
   </mesh>
  </object>
 </resources>
 <build>
  <item objectid="1" transform="1 0 0 0 1 0 0 0 1 {x} {y} {z}"/>
 </build>
</model>"#
    )?;
    out.flush()
}

/// The least of all coordinates, mm.
fn lowest(mesh: &Mesh) -> [f32; 3] {
    let places = mesh.vertices().iter().copied().map(millimetres);
    places.fold([f32::INFINITY; 3], |low, place| {
        [0, 1, 2].map(|i| low[i].min(place[i]))
    })
}

/// Text between XML tags: special characters as references, and none that XML forbids.
fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for letter in text.chars() {
        match letter {
            '&' | '<' | '>' => {
                write!(safe, "&#{};", u32::from(letter)).expect("a string takes everything");
            }
            '\u{FFFE}' | '\u{FFFF}' => safe.push(' '),
            _ if letter.is_control() => safe.push(' '),
            _ => safe.push(letter),
        }
    }
    safe
}
