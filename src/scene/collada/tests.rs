use super::*;
use proptest::prelude::*;

const GEOMETRY: &str = r##"<geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"/></technique_common></source>
<source id="n"><float_array id="na" count="6">0 0 1 0 0 -1</float_array>
<technique_common><accessor source="#na" count="2" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#n" offset="1"/><p>0 0 1 0 2 0 0 1 2 1 3 1</p></triangles>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4</vcount><p>0 1 2 3</p></polylist>
<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1</p></lines>
</mesh></geometry>"##;

fn file(nodes: &str) -> String {
    format!(
        "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n\
         <asset><unit meter=\"0.5\"/><up_axis>Z_UP</up_axis></asset>\n\
         <library_geometries>{GEOMETRY}</library_geometries>\n\
         <library_nodes><node id=\"lib\"><translate>0 0 5</translate><instance_geometry url=\"#g\"/></node></library_nodes>\n\
         <library_visual_scenes><visual_scene id=\"s\">{nodes}</visual_scene></library_visual_scenes>\n\
         <scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
    )
}

fn parse(text: &str) -> Result<RawMesh, String> {
    read(Path::new("m.dae"), text.as_bytes()).map_err(|error| error.to_string())
}

#[test]
fn vertices_split_by_normal_and_group_and_lines_count_as_vertices() {
    let mesh = parse(&file("<node><instance_geometry url=\"#g\"/></node>")).unwrap();
    assert_eq!(mesh.triangles.len(), 4);
    // 3 with the one normal and 3 with the other; 4 of the polygon; 2 of the line.
    assert_eq!(mesh.vertices.len(), 12);
    assert_eq!((mesh.up, mesh.unit_metres), (Some(UpAxis::Z), Some(0.5)));
}

#[test]
fn transformations_apply_from_the_innermost_outwards() {
    let mesh = parse(&file(
        "<node><matrix>1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix><node><rotate>0 0 2 90</rotate>\
         <scale>2 2 2</scale><instance_node url=\"#lib\"/></node></node>",
    ))
    .unwrap();
    // (1, 0, 0): lifted by 5, doubled, turned to y, moved by 10.
    let expected = [10.0, 2.0, 10.0];
    let near = |v: &[f64; 3]| (0..3).all(|i| (v[i] - expected[i]).abs() < 1e-12);
    assert!(mesh.vertices.iter().any(near), "{:?}", mesh.vertices);
}

#[test]
fn errors_name_the_line() {
    let nodes = "<node><instance_geometry url=\"#g\"/></node>";
    for (from, to, expected) in [
        ("3 1</p>", "4 1</p>", "m.dae:10: vertex 4 does not exist; there are 4"),
        ("0 1 0</float_array>", "0 nan 0</float_array>", "m.dae:4: `nan` found in <float_array>"),
        ("count=\"12\"", "count=\"13\"", "m.dae:4: 12 numbers found; count = 13"),
        (
            "count=\"4\" stride",
            "count=\"1000000000\" stride",
            "m.dae:5: 1000000000 vertices, 3 numbers",
        ),
        ("<vcount>4", "<vcount>1000000000", "m.dae:12: `1000000000` found"),
        ("<triangles count=\"2\"", "<triangles count=\"3\"", "m.dae:9: <triangles> of 2 found"),
        ("Z_UP", "UP", "m.dae:2: `UP` found"),
        ("url=\"#g\"/></node></library_nodes>", "url=\"#x\"/></node></library_nodes>", ""),
        ("<node><instance", "<node><skew>1</skew><instance", "m.dae:16: <skew> found"),
        (
            "url=\"#g\"/></node></vis",
            "url=\"a.dae#g\"/></node></vis",
            "m.dae:16: url = `a.dae#g` found",
        ),
        ("</lines>", "", "m.dae:14: not COLLADA: "),
    ] {
        let text = file(nodes).replace(from, to);
        assert_ne!(text, file(nodes), "{from}");
        match parse(&text) {
            Ok(_) => assert!(expected.is_empty(), "{to}"),
            Err(error) => assert!(!expected.is_empty() && error.starts_with(expected), "{error}"),
        }
    }
}

#[test]
fn small_files_do_not_grow() {
    let mut entities = "<!DOCTYPE COLLADA [<!ENTITY a0 \"ha\">".to_owned();
    for i in 1..40 {
        entities += &format!("<!ENTITY a{i} \"&a{0};&a{0};&a{0};\">", i - 1);
    }
    let bomb = format!("{entities}]><COLLADA>&a39;</COLLADA>");
    let error = parse(&bomb).unwrap_err();
    assert!(error.starts_with("m.dae:1: not COLLADA"), "{error}");
    // Every node instantiates the next twice.
    let mut nodes = "<node id=\"n0\"/>".to_owned();
    for i in 1..50 {
        let instance = format!("<instance_node url=\"#n{}\"/>", i - 1);
        nodes += &format!("<node id=\"n{i}\">{instance}{instance}</node>");
    }
    let error = parse(&file(&nodes)).unwrap_err();
    assert!(error.contains("more than 1048576 nodes"), "{error}");
    let error = parse(&file("<node id=\"o\"><instance_node url=\"#o\"/></node>")).unwrap_err();
    assert!(error.contains("more than 64 deep"), "{error}");
    let deep = format!("{}{}", "<a>".repeat(1 << 20), "</a>".repeat(1 << 20));
    assert!(parse(&deep).is_err());
}

#[test]
fn the_same_mesh_in_every_encoding() {
    let nodes = "<node name=\"W\u{fc}rfel\"><instance_geometry url=\"#g\"/></node>";
    let declared =
        |name: &str| format!("<?xml version=\"1.0\" encoding=\"{name}\"?>\n{}", file(nodes));
    let utf16 = |mark: &str, order: fn(u16) -> [u8; 2]| {
        (mark.to_owned() + &declared("UTF-16")).encode_utf16().flat_map(order).collect::<Vec<u8>>()
    };
    for bytes in [
        declared("UTF-8").into_bytes(),
        format!("\u{feff}{}", declared("utf-8")).into_bytes(),
        declared("ISO-8859-1").chars().map(|c| c as u8).collect(),
        utf16("\u{feff}", u16::to_le_bytes),
        utf16("\u{feff}", u16::to_be_bytes),
        utf16("", u16::to_le_bytes),
    ] {
        let mesh = read(Path::new("m.dae"), &bytes).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((mesh.triangles.len(), mesh.vertices.len()), (4, 12));
    }
    let undeclared: Vec<u8> = file(nodes).chars().map(|c| c as u8).collect();
    let error = read(Path::new("m.dae"), &undeclared).unwrap_err().to_string();
    assert!(
        error.starts_with("m.dae:16: not UTF-8 text, and no other encoding declared"),
        "{error}"
    );
}

#[test]
fn polygons_need_not_be_convex() {
    // The polygon list's square becomes a dart whose second corner is the reflex one.
    let text = file("<node><instance_geometry url=\"#g\"/></node>");
    let dart = text.replace("0 0 0 1 0 0 1 1 0 0 1 0<", "0 0 0 1 1 0 2 0 0 1 3 0<");
    let polygons = dart
        .replace("<polylist", "<polygons")
        .replace("</polylist", "</polygons")
        .replace("<vcount>4</vcount>", "");
    for text in [&dart, &polygons] {
        let mesh = parse(text).unwrap();
        let first = mesh.triangles[2][0].min(mesh.triangles[3][0]).min(mesh.triangles[2][1]);
        let cut: Vec<[u32; 3]> = mesh.triangles[2..].iter().map(|t| t.map(|i| i - first)).collect();
        assert_eq!(cut, [[3, 0, 1], [1, 2, 3]]);
    }
    let crossing = text.replace("<p>0 1 2 3</p></polylist>", "<p>0 2 1 3</p></polylist>");
    let error = parse(&crossing).unwrap_err();
    assert!(error.starts_with("m.dae:12: polygon 0: a face that crosses itself"), "{error}");
}

#[test]
fn very_many_attributes_are_refused_at_once() {
    let attributes: String = (0..200_000).map(|i| format!(" a{i}=\"\"")).collect();
    let error = parse(&file(&format!("<node{attributes}/>"))).unwrap_err();
    assert!(error.starts_with("m.dae:16: an element with 200000 attributes found"), "{error}");
}

#[test]
fn cut_off_files_are_errors_at_every_byte() {
    let text = file("<node><instance_geometry url=\"#g\"/></node>");
    for end in 0..text.len() {
        let error = parse(&text[..end]).unwrap_err();
        assert!(error.starts_with("m.dae:"), "{error}");
    }
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200), at in 0usize..1500, byte in any::<u8>()) {
        let _ = read(Path::new("m.dae"), &bytes);
        let mut good = file("<node><rotate>0 0 1 3</rotate><instance_node url=\"#lib\"/></node>").into_bytes();
        let at = at % good.len();
        good[at] = byte;
        let _ = read(Path::new("m.dae"), &good);
    }
}
