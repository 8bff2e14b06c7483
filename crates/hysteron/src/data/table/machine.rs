//! The memory that the machine can spare.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// What is taken where the system does not say what is free.
const ELSEWHERE: u64 = 2 << 30;

/// Half of the memory that was free when this was first asked; 2 GiB on systems without `/proc`.
pub(super) fn half_of_what_is_free() -> u64 {
    static HALF: LazyLock<u64> =
        LazyLock::new(|| free(Path::new("/")).unwrap_or(2 * ELSEWHERE) / 2);
    *HALF
}

/// The least of what the machine has, what the groups of this process may take, and what its
/// limit of addresses leaves. `root` is the folder that has `proc` and `sys`.
fn free(root: &Path) -> Option<u64> {
    let read = |path: &Path| std::fs::read_to_string(root.join(path)).ok();
    let machine = kibibytes(&read(Path::new("proc/meminfo"))?, "MemAvailable:")?;
    let addresses = read(Path::new("proc/self/limits")).and_then(|limits| {
        let line = limits
            .lines()
            .find_map(|line| line.strip_prefix("Max address space"))?;
        // `unlimited` is no number.
        let most = line.split_whitespace().next()?.parse::<u64>().ok()?;
        let taken = kibibytes(&read(Path::new("proc/self/status"))?, "VmSize:")?;
        Some(most.saturating_sub(taken))
    });
    let groups = read(Path::new("proc/self/cgroup")).unwrap_or_default();
    let groups = groups.lines().flat_map(folders);
    let groups = groups.filter_map(|folder| {
        let number = |name: &str| read(&folder.join(name))?.trim().parse::<u64>().ok();
        let most = number("memory.max").or_else(|| number("memory.limit_in_bytes"))?;
        let taken = number("memory.current").or_else(|| number("memory.usage_in_bytes"))?;
        // What is kept of files is given up when memory is needed.
        let kept = read(&folder.join("memory.stat")).and_then(|stat| first(&stat, "inactive_file"));
        Some(most.saturating_sub(taken.saturating_sub(kept.unwrap_or(0))))
    });
    groups.chain(addresses).chain([machine]).min()
}

/// The folders of a group and of those above it, from a line `0::/a/b` (version 2) or
/// `4:memory:/a/b` (version 1).
fn folders(line: &str) -> Vec<PathBuf> {
    let mut parts = line.splitn(3, ':').skip(1);
    let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else {
        return Vec::new();
    };
    let base = match controllers {
        "" => "sys/fs/cgroup",
        _ if controllers.split(',').any(|name| name == "memory") => "sys/fs/cgroup/memory",
        _ => return Vec::new(),
    };
    let above = Path::new(path.trim_start_matches('/')).ancestors();
    above.map(|path| Path::new(base).join(path)).collect()
}

/// The number after a name at the beginning of a line.
fn first(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

fn kibibytes(text: &str, name: &str) -> Option<u64> {
    first(text, name)?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A machine with 8 GiB free.
    fn machine(files: &[(&str, &str)]) -> Option<u64> {
        let root = tempfile::tempdir().unwrap();
        let free = (
            "proc/meminfo",
            "MemTotal: 9 kB\nMemAvailable:    8388608 kB\n",
        );
        for (path, text) in files.iter().chain([&free]) {
            let path = root.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        super::free(root.path())
    }

    #[test]
    fn the_tightest_limit_counts() {
        const GIB: u64 = 1 << 30;
        assert_eq!(machine(&[]), Some(8 * GIB));
        assert_eq!(free(Path::new("/no such folder")), None);
        let unlimited = (
            "proc/self/limits",
            "Max address space  unlimited  unlimited  bytes\n",
        );
        assert_eq!(machine(&[unlimited]), Some(8 * GIB));
        let limits = (
            "proc/self/limits",
            "Max address space  3221225472  unlimited  bytes\n",
        );
        let status = ("proc/self/status", "VmPeak: 9 kB\nVmSize:  1048576 kB\n");
        assert_eq!(machine(&[limits, status]), Some(2 * GIB));
        // A limit of a group above, beside one without.
        let two = [
            ("proc/self/cgroup", "0::/a/b\n"),
            ("sys/fs/cgroup/a/b/memory.max", "max\n"),
            ("sys/fs/cgroup/a/b/memory.current", "1\n"),
            ("sys/fs/cgroup/a/memory.max", "1073741824\n"),
            ("sys/fs/cgroup/a/memory.current", "1073741824\n"),
            (
                "sys/fs/cgroup/a/memory.stat",
                "anon 1\ninactive_file 536870912\n",
            ),
        ];
        assert_eq!(machine(&two), Some(GIB / 2));
        let one = [
            ("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/x\n"),
            (
                "sys/fs/cgroup/memory/x/memory.limit_in_bytes",
                "2147483648\n",
            ),
            (
                "sys/fs/cgroup/memory/x/memory.usage_in_bytes",
                "1073741824\n",
            ),
        ];
        assert_eq!(machine(&one), Some(GIB));
    }
}
