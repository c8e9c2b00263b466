//! The files as another reader sees them.

use crate::common::{coins, drafted, error, marked, mesh};
use coinmc_solid::{Edge, Mesh, Shape, write_3mf, write_openscad, write_stl};
use std::collections::HashMap;
use std::io::{self, Cursor, Read, Write};

type Facet = ([f32; 3], [[f32; 3]; 3]);

fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut file = Vec::new();
    write_stl(mesh, &mut file).expect("a file");
    file
}

/// Normals and corners.
fn facets(file: &[u8]) -> Vec<Facet> {
    let count = u32::from_le_bytes(file[80..84].try_into().expect("four bytes"));
    assert_eq!(file.len(), 84 + 50 * count as usize);
    let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
    file[84..]
        .chunks_exact(50)
        .map(|facet| {
            assert_eq!(&facet[48..], [0, 0]);
            let n: Vec<f32> = facet[..48].chunks_exact(4).map(number).collect();
            let vector = |i: usize| [n[i], n[i + 1], n[i + 2]];
            (vector(0), [vector(3), vector(6), vector(9)])
        })
        .collect()
}

/// Closed, by the places of the corners alone: what a slicer sees.
fn is_closed(facets: &[Facet]) -> bool {
    let mut edges: HashMap<_, i32> = HashMap::new();
    for (_, corners) in facets {
        let [a, b, c] = corners.map(|place| place.map(f32::to_bits));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from, to)).or_default() += 1;
        }
    }
    edges
        .iter()
        .all(|(&(from, to), &count)| from != to && count == 1 && edges.get(&(to, from)) == Some(&1))
}

/// Six times the volume that a triangle spans with the origin, and its normal times twice its area.
fn span([a, b, c]: [[f32; 3]; 3]) -> (f64, [f64; 3]) {
    let [a, b, c] = [a, b, c].map(|place| place.map(f64::from));
    let (p, q) = (
        [0, 1, 2].map(|i| b[i] - a[i]),
        [0, 1, 2].map(|i| c[i] - a[i]),
    );
    let normal = [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ];
    (
        a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2],
        normal,
    )
}

#[test]
fn an_stl_file_is_closed_and_in_millimetres() {
    for shape in coins() {
        let file = stl(&mesh(&shape));
        assert!(!file.starts_with(b"solid"));
        let facets = facets(&file);
        assert!(is_closed(&facets), "{shape:?}");
        let volume: f64 = facets
            .iter()
            .map(|(_, corners)| span(*corners).0 / 6.0)
            .sum();
        assert!(error(volume, 1e9 * shape.volume_m3()) < 1e-3);
    }
}

#[test]
fn normals_are_those_of_the_corners() {
    for shape in coins() {
        for (normal, corners) in facets(&stl(&mesh(&shape))) {
            let (_, expected) = span(corners);
            let area = expected.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(area > 0.0);
            for (found, expected) in normal.into_iter().zip(expected) {
                assert!(
                    (f64::from(found) - expected / area).abs() < 2e-3,
                    "{corners:?}"
                );
            }
        }
    }
}

/// Sizes at which single precision has least to spare: the smallest parts of the greatest coin.
#[test]
fn single_precision_keeps_corners_apart() {
    for radius_m in [1e-5, 2e-4] {
        let edge = Edge::Rounded { radius_m };
        let coin = marked(Shape::new(1.0, 1.0, edge).expect("a coin"));
        let mesh = coin.mesh(3e-7).expect("a mesh");
        assert!(mesh.is_watertight() && is_closed(&facets(&stl(&mesh))));
    }
}

fn package(mesh: &Mesh, title: &str) -> Vec<u8> {
    let mut file = Vec::new();
    write_3mf(mesh, title, &mut file).expect("a file");
    file
}

fn part(file: &[u8], name: &str) -> String {
    let mut archive = zip::ZipArchive::new(Cursor::new(file)).expect("an archive");
    let mut text = String::new();
    archive
        .by_name(name)
        .expect("a part")
        .read_to_string(&mut text)
        .expect("text");
    text
}

/// The values of the attributes on the lines of an element.
fn attributes<'a>(model: &'a str, element: &str) -> Vec<Vec<&'a str>> {
    model
        .lines()
        .filter(|line| line.trim_start().starts_with(&format!("<{element} ")))
        .map(|line| line.split('"').skip(1).step_by(2).collect())
        .collect()
}

#[test]
fn a_package_holds_the_mesh_in_millimetres() {
    for shape in coins() {
        let mesh = mesh(&shape);
        let model = part(&package(&mesh, "coin"), "3D/3dmodel.model");
        assert!(model.contains("<model unit=\"millimeter\""));
        let places: Vec<[f64; 3]> = attributes(&model, "vertex")
            .into_iter()
            .map(|v| [0, 1, 2].map(|i| v[i].parse().expect("a number")))
            .collect();
        let triangles: Vec<[u32; 3]> = attributes(&model, "triangle")
            .into_iter()
            .map(|t| [0, 1, 2].map(|i| t[i].parse().expect("an index")))
            .collect();
        assert_eq!(triangles, mesh.triangles());
        assert_eq!(places.len(), mesh.vertices().len());
        for (found, expected) in places.iter().zip(mesh.vertices()) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - 1e3 * expected).abs() < 1e-6);
            }
        }
    }
}

/// The build item moves the lowest corner to the origin.
#[test]
fn a_package_is_where_printers_build() {
    let shape = Shape::new(0.02, 0.006, Edge::Sharp).expect("a coin");
    let mesh = mesh(&shape);
    let model = part(&package(&mesh, "coin"), "3D/3dmodel.model");
    let item = attributes(&model, "item").remove(0);
    let numbers: Vec<f64> = item[1]
        .split(' ')
        .map(|n| n.parse().expect("a number"))
        .collect();
    assert_eq!(&numbers[..9], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    for i in 0..3 {
        let least = mesh
            .vertices()
            .iter()
            .map(|v| 1e3 * v[i])
            .fold(0.0, f64::min);
        assert!((numbers[9 + i] + least).abs() < 1e-6);
    }
}

#[test]
fn a_package_has_the_parts_that_readers_look_for() {
    let file = package(&mesh(&coins()[0]), "coin");
    let types = part(&file, "[Content_Types].xml");
    assert!(types.contains("Extension=\"model\"") && types.contains("Extension=\"rels\""));
    assert!(part(&file, "_rels/.rels").contains("Target=\"/3D/3dmodel.model\""));
}

#[test]
fn a_title_is_text_whatever_it_holds() {
    let file = package(&mesh(&coins()[0]), "a < b & c > d\u{0}\n\u{FFFF}é");
    let model = part(&file, "3D/3dmodel.model");
    let title = "<metadata name=\"Title\">a &#60; b &#38; c &#62; d   é</metadata>";
    assert!(model.contains(title), "{}", &model[..500]);
}

#[test]
fn the_same_coin_gives_the_same_bytes() {
    for shape in coins() {
        assert_eq!(stl(&mesh(&shape)), stl(&mesh(&shape)));
        let file = package(&mesh(&shape), "coin");
        assert_eq!(file, package(&mesh(&shape), "coin"));
        let mut archive = zip::ZipArchive::new(Cursor::new(file)).expect("an archive");
        for i in 0..archive.len() {
            let part = archive.by_index(i).expect("a part");
            assert_eq!(part.last_modified(), Some(zip::DateTime::DEFAULT));
            assert_eq!(part.unix_mode(), Some(0o100_644));
        }
    }
}

fn openscad(shape: &Shape) -> String {
    let mut file = Vec::new();
    write_openscad(shape, &mut file).expect("a file");
    String::from_utf8(file).expect("text")
}

#[test]
fn openscad_source_begins_with_the_measures() {
    let plain = Shape::new(0.02325, 0.00233, Edge::Rounded { radius_m: 3e-4 }).expect("a coin");
    let source = openscad(&marked(plain));
    let measures: Vec<&str> = source.lines().skip(2).take(12).collect();
    let expected = [
        "diameter = 23.25;",
        "thickness = 2.33;",
        "edge = \"rounded\"; // \"sharp\", \"rounded\" or \"chamfered\"",
        "edge_size = 0.3; // radius of the rounding, or what the chamfer takes of face and side",
        "draft = 0; // degrees between side and axis, of sharp edges; above 0 heads is the wider face",
        "marks = true; // 3 recesses on heads, 6 on tails, half of the ring each",
        "mark_inner = 4.53; // radii of the ring",
        "mark_outer = 9.06;",
        "mark_depth = 0.466;",
        "heads = 3;",
        "tails = 6;",
        "$fn = 180; // corners of a circle",
    ];
    assert_eq!(measures, expected);
    assert!(openscad(&plain).contains("\nmarks = false;"));
    let sharp = Shape::new(0.02, 0.002, Edge::Sharp).expect("a coin");
    assert!(openscad(&sharp).contains("edge = \"sharp\";"));
    let chamfered = Shape::new(0.02, 0.002, Edge::Chamfered { size_m: 5e-4 }).expect("a coin");
    assert!(openscad(&chamfered).contains("edge = \"chamfered\";"));
}

/// Heads is towards +z in all files: with a draft above 0 the wider face.
#[test]
fn the_wider_face_of_a_conical_coin_is_where_its_draft_says() {
    for draft in [8.0, -20.0] {
        let coin = drafted(draft);
        let widest = |z: f32| {
            let corners = facets(&stl(&mesh(&coin)))
                .into_iter()
                .flat_map(|(_, at)| at);
            let on_face = corners.filter(|corner| corner[2] == z);
            on_face.map(|[x, y, _]| x.hypot(y)).fold(0.0, f32::max)
        };
        let [heads, tails] = coin.face_radii_m();
        for (found, expected) in [(widest(3.0), heads), (widest(-3.0), tails)] {
            // corners lie outside of the circle
            let outside = f64::from(found) / (1e3 * expected) - 1.0;
            assert!(
                (0.0..1e-3).contains(&outside),
                "{draft}: {found} {expected}"
            );
        }
        assert!(openscad(&coin).contains(&format!("\ndraft = {draft};")));
    }
}

/// Fails after some bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = bytes.len().min(self.0);
        self.0 -= room;
        if room == 0 {
            Err(io::ErrorKind::StorageFull.into())
        } else {
            Ok(room)
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error() {
    let shape = coins()[0];
    let mesh = mesh(&shape);
    for room in [0, 60, 83, 100, 1000] {
        for result in [
            write_stl(&mesh, Full(room)),
            write_3mf(&mesh, "coin", Full(room)),
            write_openscad(&shape, Full(room)),
        ] {
            assert_eq!(result.expect_err("full").kind(), io::ErrorKind::StorageFull);
        }
    }
}
