//! What the page has of its poses, and what texts cannot do to it.

use super::super::report::shell::{LICENCE, MOLECULES};
use super::*;

const PROTEIN: &str =
    "ATOM      1  CA  GLY A   1       0.000   0.000   0.000  1.00  0.00           C\nEND\n";

/// A pose of two atoms whose way out has so many frames.
fn pose(label: &str, cluster: usize, frames: usize) -> ShownPose {
    let frame = |number: usize| {
        let along = number as f64;
        let positions = vec![Point::new(along, 0.0, 0.0), Point::new(along, 1.5, -0.01)];
        WayFrame { positions, along, energy: -30.0 + 5.0 * along }
    };
    ShownPose {
        label: label.to_owned(),
        sdf: format!("{label}\n\n\n  2  1 ..."),
        energy: -30.0,
        score: -31.25,
        cluster,
        population: 7,
        peak: Some(12.0),
        barrier: (frames > 0).then_some(40.5),
        rmsd: None,
        way_out: (0..frames).map(frame).collect(),
    }
}

/// A page about these poses and their minima, and a thousand minima more.
fn page(poses: &[ShownPose], reference: Option<&str>) -> String {
    let shown = poses.iter().enumerate().map(|(number, pose)| Minimum {
        energy: pose.energy,
        rmsd: pose.rmsd,
        distance: 0.5 * number as f64,
        pose: Some(number),
    });
    let more = (0..1000).map(|number| Minimum {
        energy: if number == 999 { f64::INFINITY } else { -20.0 + f64::from(number * number) },
        rmsd: reference.map(|_| 0.01 * f64::from(number)),
        distance: 0.02 * f64::from(number),
        pose: None,
    });
    poses_page(&PosesPage {
        title: "a <complex> & more",
        facts: &[("seed", "1 & 2".to_owned())],
        meaning: "Energies are <sums>.",
        protein: PROTEIN,
        poses,
        reference,
        reference_energy: reference.map(|_| -35.0),
        minima: &shown.chain(more).collect::<Vec<_>>(),
        before: &[5000.0, f64::NAN, -3.0, 12.0],
        after: &[-30.0, -20.0],
    })
}

/// The page without the library and its licence.
fn own(page: &str) -> String {
    page.replacen(MOLECULES, "", 1).replacen(LICENCE, "", 1)
}

/// The data of the viewer, as a browser reads them.
fn data(page: &str) -> &str {
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    rest.split_once("</script>").unwrap().0
}

#[test]
fn every_pose_has_its_row_its_point_and_its_way() {
    let poses = [pose("one", 0, 3), pose("two", 1, 0), pose("three", 0, 2)];
    let page = page(&poses, None);
    for (number, pose) in poses.iter().enumerate() {
        assert_eq!(page.matches(&format!("<tr data-pose=\"{number}\"")).count(), 1);
        assert_eq!(page.matches(&format!("class=\"pose\" data-pose=\"{number}\"")).count(), 1);
        let ways = page.matches(&format!("class=\"way\" data-pose=\"{number}\"")).count();
        assert_eq!(ways, usize::from(!pose.way_out.is_empty()));
    }
    // As many places of the cursor as frames.
    let (_, places) = page.split_once("data-places=\"").unwrap();
    assert_eq!(places.split_once('"').unwrap().0.split(' ').count(), 3);
    assert!(page.contains(
        "<td>\u{2212}30.0</td><td>\u{2212}31.2</td><td>1</td><td>7</td><td>12.0</td><td>40.5</td>"
    ));
    assert!(!page.contains(">RMSD<"), "no pose has one");
    assert!(page.contains("distance of centres, Å") && page.contains("1002 minima"));
    assert!(page.contains("energies before and after descent"));
    let own = own(&page);
    assert!(!own.contains("NaN") && !own.contains("inf"), "what is not finite is not drawn");
}

#[test]
fn with_a_reference_the_funnel_is_about_it() {
    let with = ShownPose { rmsd: Some(1.234), ..pose("one", 0, 0) };
    let page = page(&[with], Some("ref\n\n\n"));
    assert!(page.contains(">RMSD<") && page.contains("<td>1.23</td>"));
    assert!(page.contains("RMSD, Å") && page.contains("the reference: -35.0 kJ/mol"));
    assert!(data(&page).contains("\"reference\":\"ref\\u000a\\u000a\\u000a\""));
}

#[test]
fn coordinates_of_ways_are_whole_multiples_in_sixteen_bits() {
    let bytes = |positions: Vec<Point>| {
        let frame = WayFrame { positions, along: 0.0, energy: f64::NAN };
        data::json(&PosesPage {
            title: "",
            facts: &[],
            meaning: "",
            protein: "",
            poses: &[ShownPose { way_out: vec![frame], ..pose("one", 0, 0) }],
            reference: None,
            reference_energy: None,
            minima: &[],
            before: &[],
            after: &[],
        })
    };
    // 1.25, −0.01 and 327.67 in hundredths: 125, −1 and 32767.
    let json = bytes(vec![Point::new(1.25, -0.01, 327.67)]);
    assert!(
        json.contains(
            "\"unit\":0.01,\"told\":[[\"0.0\",\"unknown\"]],\"coordinates\":\"fQD///9/\""
        ),
        "{json}"
    );
    assert!(bytes(vec![Point::new(400.0, 0.0, 0.0)]).contains("\"unit\":0.02,"));
    bytes(vec![Point::new(f64::NAN, f64::INFINITY, 1e300)]);
}

#[test]
fn texts_cannot_break_the_page_and_nothing_is_fetched() {
    let bad = "</script><script>alert(1)</script><!-- \"'&\u{2028}";
    let poses = [pose(bad, 0, 2)];
    let text = page(&poses, Some(bad));
    let own = own(&text);
    assert_eq!(own.matches("<script").count(), 3);
    assert_eq!(own.matches("</script>").count(), 3);
    assert!(!own.contains("alert(1)</") && !own.contains("<complex>") && !own.contains("<sums>"));
    assert!(own.contains("Content-Security-Policy") && own.contains("default-src 'none'"));
    for reference in ["http:", "https:", "src=", "@import", "url("] {
        let allowed = own.matches(reference).count();
        assert_eq!(allowed, 0, "{reference}");
    }
    assert_eq!(text, page(&poses, Some(bad)), "the same bytes");
}

#[test]
fn a_page_without_poses_says_so() {
    let text = page(&[], None);
    assert!(
        text.contains("No pose was found.")
            && !text.contains("id=\"viewer\"")
            && !text.contains("<script")
    );
    let empty = poses_page(&PosesPage {
        title: "t",
        facts: &[],
        meaning: "",
        protein: "",
        poses: &[],
        reference: None,
        reference_energy: None,
        minima: &[],
        before: &[f64::NAN],
        after: &[],
    });
    assert!(!empty.contains("<figure"));
}
