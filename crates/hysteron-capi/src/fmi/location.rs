//! Where the resources are: a URI in FMI 2.0.

use super::{Problem, Result};
use std::path::PathBuf;

/// The folder that a `file:` URI names; what has no scheme is taken as a path, as some tools give
/// it.
pub(crate) fn of_uri(uri: &str) -> Result<PathBuf> {
    let path = path_of_uri(uri, cfg!(windows))
        .map_err(|problem| Problem(format!("fmuResourceLocation `{uri}`: {problem}")))?;
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStringExt;
        Ok(std::ffi::OsString::from_vec(path).into())
    }
    #[cfg(not(unix))]
    match String::from_utf8(path) {
        Ok(path) => Ok(path.into()),
        Err(_) => Err(Problem(format!(
            "fmuResourceLocation `{uri}`: it is not UTF-8"
        ))),
    }
}

/// RFC 8089: `file:/path`, `file:///path`, `file://localhost/path`; on Windows also drive letters
/// and hosts.
fn path_of_uri(uri: &str, windows: bool) -> std::result::Result<Vec<u8>, &'static str> {
    let is_file = uri
        .get(..5)
        .is_some_and(|scheme| scheme.eq_ignore_ascii_case("file:"));
    if !is_file {
        return match uri.contains("://") {
            true => Err("only `file:` can be read"),
            false => Ok(uri.as_bytes().to_vec()),
        };
    }
    let rest = &uri[5..];
    let Some(after) = rest.strip_prefix("//") else {
        return Ok(without_slash(decoded(rest)?, windows));
    };
    let (host, path) = after.split_at(after.find('/').unwrap_or(after.len()));
    if host.is_empty() || host.eq_ignore_ascii_case("localhost") {
        return Ok(without_slash(decoded(path)?, windows));
    }
    match windows {
        // One slash too few, but it can only mean this.
        true if is_drive(host.as_bytes()) => decoded(after),
        true => Ok([b"//", &decoded(after)?[..]].concat()),
        false => Err("it is on another host"),
    }
}

fn is_drive(path: &[u8]) -> bool {
    matches!(path, [letter, b':' | b'|', ..] if letter.is_ascii_alphabetic())
}

/// `/C:/folder` is `C:/folder`.
fn without_slash(path: Vec<u8>, windows: bool) -> Vec<u8> {
    match path.strip_prefix(b"/") {
        Some(rest) if windows && is_drive(rest) => [&rest[..1], b":", &rest[2..]].concat(),
        _ => path,
    }
}

fn decoded(text: &str) -> std::result::Result<Vec<u8>, &'static str> {
    let mut bytes = text.bytes();
    let mut path = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        if byte != b'%' {
            path.push(byte);
            continue;
        }
        let mut digit = || bytes.next().and_then(|byte| char::from(byte).to_digit(16));
        let (Some(high), Some(low)) = (digit(), digit()) else {
            return Err("a `%` is not followed by two hexadecimal digits");
        };
        path.push((high * 16 + low) as u8);
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::path_of_uri;

    #[test]
    fn uris_and_what_tools_make_of_them() {
        let cases: [(&str, Option<&str>, Option<&str>); 14] = [
            ("file:///tmp/a", Some("/tmp/a"), Some("/tmp/a")),
            ("file:/tmp/a", Some("/tmp/a"), Some("/tmp/a")),
            ("FILE://localhost/tmp/a", Some("/tmp/a"), Some("/tmp/a")),
            (
                "file:///tmp/a%20b%C3%A4%25",
                Some("/tmp/a bä%"),
                Some("/tmp/a bä%"),
            ),
            ("/tmp/a%20b", Some("/tmp/a%20b"), Some("/tmp/a%20b")),
            ("file:///C:/a%20b/c", Some("/C:/a b/c"), Some("C:/a b/c")),
            ("file:///C|/a", Some("/C|/a"), Some("C:/a")),
            ("file:/C:/a", Some("/C:/a"), Some("C:/a")),
            ("file://C:/a", None, Some("C:/a")),
            ("file://server/share/a", None, Some("//server/share/a")),
            (
                "file:////server/share/a",
                Some("//server/share/a"),
                Some("//server/share/a"),
            ),
            ("https://host/a", None, None),
            ("file:///a%2", None, None),
            ("file:///a%zz", None, None),
        ];
        for (uri, unix, windows) in cases {
            for (expected, on_windows) in [(unix, false), (windows, true)] {
                let path = path_of_uri(uri, on_windows).ok();
                let expected = expected.map(|path| path.as_bytes().to_vec());
                assert_eq!(path, expected, "{uri}, Windows: {on_windows}");
            }
        }
    }
}
