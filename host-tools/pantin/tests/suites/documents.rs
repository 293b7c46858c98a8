//! The documents of the repository, whose run lines other suites check.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every document of the repository: its path from the root, and its text.
pub fn all() -> Vec<(String, String)> {
    let mut documents = vec![];
    collect(&root(), String::new(), &mut documents);
    assert!(documents.len() > 15, "only {} documents", documents.len());
    documents
}

fn collect(folder: &Path, below: String, documents: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{below}{name}");
        if entry.file_type().unwrap().is_dir() {
            if !name.starts_with('.') && !["target", "node_modules", "corpus"].contains(&name.as_str()) {
                collect(&entry.path(), format!("{path}/"), documents);
            }
        } else if name.ends_with(".md") {
            documents.push((path, std::fs::read_to_string(entry.path()).unwrap()));
        }
    }
}
