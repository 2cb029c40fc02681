//! Pages, opened in a headless Chromium.

use super::Scratch;
use std::process::Command;

/// A headless Chromium, unless there is none and none is required.
pub fn has_browser() -> bool {
    let there = Command::new("chromium").arg("--version").output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_BROWSER").is_some_and(|value| value == "1");
        assert!(!required, "no chromium");
        println!("not tested: no chromium");
    }
    there
}

/// A browser's window.
#[derive(Clone, Debug)]
pub struct Window {
    /// Width and height.
    pub size: [u32; 2],
    /// Whether the user likes dark pages.
    pub is_dark: bool,
    /// For how many milliseconds of the page's own time its scripts run; `None`: until the page is loaded and idle.
    pub runs: Option<u32>,
}

impl Window {
    /// A light one, in which scripts run for four seconds of the page's own time.
    pub fn new(width: u32, height: u32) -> Window {
        Window { size: [width, height], is_dark: false, runs: Some(4000) }
    }

    /// Opens a page and gives its marks. `what` says in messages what was looked at.
    ///
    /// # Panics
    /// If the browser does not start, or does not answer within a quarter of an hour: such a test fails, and does not hang.
    pub fn open(&self, scratch: &Scratch, page: &str, what: &str) -> Marks {
        scratch.write("watched.html", page);
        let [width, height] = self.size;
        let output = Command::new("timeout")
            .args(["900", "chromium", "--headless", "--no-sandbox", "--disable-gpu-sandbox"])
            .args(["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--dump-dom"])
            .args(self.runs.map(|runs| format!("--virtual-time-budget={runs}")))
            .arg(format!("--window-size={width},{height}"))
            .arg(format!("--blink-settings=preferredColorScheme={}", u8::from(!self.is_dark)))
            .arg(format!("--user-data-dir={}", scratch.path("browser").display()))
            .arg(scratch.path("watched.html"))
            .output();
        let output = output.expect("chromium starts");
        let dumped = String::from_utf8_lossy(&output.stdout);
        let root = dumped.split("<html").nth(1).and_then(|rest| rest.split('>').next());
        match root {
            Some(root) => Marks { what: format!("{what} {self:?}"), root: root.to_owned() },
            None => panic!("{what} {self:?}: {}", String::from_utf8_lossy(&output.stderr)),
        }
    }
}

/// What a page's script has written at the root element: attributes `data-NAME`.
#[derive(Debug)]
pub struct Marks {
    what: String,
    root: String,
}

impl Marks {
    /// The value of one.
    pub fn said(&self, name: &str) -> &str {
        let text = self.root.split(&format!("data-{name}=\"")).nth(1);
        let text = text.and_then(|rest| rest.split('"').next());
        text.unwrap_or_else(|| panic!("{name} is missing: {self:?}"))
    }

    /// The value of one that is a count.
    pub fn count(&self, name: &str) -> u32 {
        let text = self.said(name);
        text.parse().unwrap_or_else(|_| panic!("{name} is no count: {self:?}"))
    }
}
