use super::linkage::fitting_names;
use super::robot::Link;

#[test]
fn links_of_the_same_name_are_told_apart_by_the_first_number_that_is_free() {
    let named = |name: &&str| Link { name: (*name).to_owned(), bodies: Vec::new(), joint: None };
    let names = |given: &[&str]| -> Vec<String> {
        let links = fitting_names(given.iter().map(named).collect());
        links.into_iter().map(|link| link.name).collect()
    };
    assert_eq!(
        names(&["a", "a", "a-2", "a", "a/b", "a-b", "", "", "a-4", "a"]),
        ["a", "a-2", "a-2-2", "a-3", "a-b", "a-b-2", "link", "-2", "a-4", "a-5"]
    );
    let all = names(&["a"; 1000]);
    assert_eq!((all[0].as_str(), all[1].as_str(), all[999].as_str()), ("a", "a-2", "a-1000"));
}
