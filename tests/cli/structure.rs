//! The arrows between the server's modules.

use std::path::{Path, PathBuf};

/// The sources of a module and of what is below it.
fn sources(module: &str) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open = vec![root.join(module)];
    let mut files = vec![root.join(format!("{module}.rs"))];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("the module has a folder") {
            let path = entry.expect("a readable entry").path();
            let list = if path.is_dir() { &mut open } else { &mut files };
            list.push(path);
        }
    }
    let text = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a readable source");
        (path, text)
    };
    files.into_iter().map(text).collect()
}

#[test]
fn exports_and_pictures_know_plans_and_nothing_of_who_asks_for_them() {
    // Their tests read scenarios and draw the plan that reports have as a sample.
    for (module, given) in [("export", ["clock", "wire"]), ("plot", ["report", "wire"])] {
        let sources = sources(module);
        assert!(sources.len() > 5, "{module}");
        for (path, text) in sources {
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            for tail in code.flat_map(|line| line.split("crate::").skip(1)) {
                let used: String = tail.chars().take_while(|c| c.is_alphanumeric()).collect();
                let allowed = used == module || given.contains(&used.as_str());
                assert!(allowed, "{} uses {used}", path.display());
            }
        }
    }
}
