//! What a shell and `man` show: it follows the commands.

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::path::Path;

fn hysteron(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("hysteron").unwrap();
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

/// Names in the list of commands that a help text has.
fn commands(help: &str) -> Vec<String> {
    let (_, list) = help.split_once("\nCommands:\n").unwrap();
    let list = list.split("\n\n").next().unwrap();
    let entries = list.lines().filter(|line| !line.starts_with("   "));
    let names = entries.map(|line| line.split_whitespace().next().unwrap().to_owned());
    names.filter(|name| name != "help").collect()
}

fn help(folder: &Path, of: &[&str]) -> String {
    let arguments = [of, &["--help"]].concat();
    String::from_utf8(hysteron(folder, &arguments).stdout).unwrap()
}

#[test]
fn each_shell_completes_each_command() {
    let folder = tempfile::tempdir().unwrap();
    let names = commands(&help(folder.path(), &[]));
    assert!(names.len() > 10, "{names:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = hysteron(folder.path(), &["completions", shell]);
        assert!(done.status.success() && done.stderr.is_empty());
        let script = String::from_utf8(done.stdout).unwrap();
        for word in names.iter().map(String::as_str).chain(["hold-out"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let wrong = hysteron(folder.path(), &["completions", "tcsh"]);
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn each_command_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = || hysteron(folder, &["man", "-o", "pages"]);
    assert!(write().status.success());
    let mut wanted = BTreeSet::from(["hysteron.1".to_owned()]);
    for name in commands(&help(folder, &[])) {
        wanted.insert(format!("hysteron-{name}.1"));
        let own = help(folder, &[&name]);
        if own.contains("\nCommands:\n") {
            let below = commands(&own).into_iter();
            wanted.extend(below.map(|below| format!("hysteron-{name}-{below}.1")));
        }
    }
    let pages = std::fs::read_dir(folder.join("pages")).unwrap();
    let names = pages.map(|page| page.unwrap().file_name().into_string().unwrap());
    let found: BTreeSet<String> = names.filter(|name| name.ends_with(".1")).collect();
    assert_eq!(found, wanted);
    let fit = std::fs::read_to_string(folder.join("pages/hysteron-fit.1")).unwrap();
    assert!(fit.starts_with(".") && fit.contains("hold") && fit.contains("Example"));
    // Its own pages are replaced, those of others are not.
    assert!(write().status.success());
    std::fs::write(folder.join("pages/hysteron-fit.1"), "mine").unwrap();
    let refused = write();
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(
        said.contains("hysteron-fit.1") && said.contains("--force"),
        "{said}"
    );
}
