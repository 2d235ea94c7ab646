//! Where an importer says that the resources are: a URI in FMI 2, a path in FMI 3.

use std::path::PathBuf;

/// The folder of a `file` URI, percent-decoded.
///
/// # Errors
/// Fault of it.
pub fn of_uri(uri: &str) -> Result<PathBuf, String> {
    let not = |what: &str| format!("the resource location `{uri}` {what}: give `file:///` and an absolute path");
    let scheme = uri.get(..5).filter(|scheme| scheme.eq_ignore_ascii_case("file:"));
    scheme.ok_or_else(|| not("is no URI of a file"))?;
    let rest = &uri[5..];
    let path = match rest.strip_prefix("//") {
        Some(with_host) => {
            let (host, path) = with_host.split_at(with_host.find('/').unwrap_or(with_host.len()));
            if !host.is_empty() && !host.eq_ignore_ascii_case("localhost") {
                return Err(not(&format!("names the host `{host}`")));
            }
            path
        }
        None => rest,
    };
    if !path.starts_with('/') {
        return Err(not("has no absolute path"));
    }
    let text = decoded(path).ok_or_else(|| not("is not percent-encoded UTF-8"))?;
    let bytes = text.as_bytes();
    let drive = bytes.len() > 2 && bytes[1].is_ascii_alphabetic() && bytes[2] == b':';
    Ok(PathBuf::from(if drive { &text[1..] } else { &text }))
}

/// The folder of a `file` URI. An importer that does not encode is understood where only its spelling exists.
///
/// # Errors
/// Fault of the URI.
pub fn resolve(uri: &str) -> Result<PathBuf, String> {
    let folder = of_uri(uri)?;
    if folder.exists() {
        return Ok(folder);
    }
    let literal = of_uri(&uri.replace('%', "%25"))?;
    Ok(if literal.exists() { literal } else { folder })
}

/// A percent sign that two hexadecimal digits do not follow stands for itself: importers that do not encode exist.
fn decoded(path: &str) -> Option<String> {
    let bytes = path.as_bytes();
    let digit = |k: usize| bytes.get(k).and_then(|&b| char::from(b).to_digit(16));
    let mut out = Vec::with_capacity(bytes.len());
    let mut k = 0;
    while k < bytes.len() {
        match (bytes[k], digit(k + 1), digit(k + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((high * 16 + low) as u8);
                k += 3;
            }
            (byte, _, _) => {
                out.push(byte);
                k += 1;
            }
        }
    }
    String::from_utf8(out).ok().filter(|text| !text.contains('\0'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_folder_with_a_percent_sign_is_found_encoded_and_not() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("a%20b");
        std::fs::create_dir(&folder).unwrap();
        let literal = format!("file://{}", folder.display());
        assert_eq!(resolve(&literal).unwrap(), folder);
        assert_eq!(resolve(&literal.replace('%', "%25")).unwrap(), folder);
        std::fs::create_dir(root.path().join("a b")).unwrap();
        assert_eq!(resolve(&literal).unwrap(), root.path().join("a b"));
    }

    #[test]
    fn all_spellings_of_a_file_are_understood() {
        let cases = [
            ("file:/x/y", "/x/y"),
            ("file:///x/y/", "/x/y/"),
            ("file://localhost/x", "/x"),
            ("FILE:///x", "/x"),
            ("file:///a%20b/%C3%BCber", "/a b/über"),
            ("file:///a b/über", "/a b/über"),
            ("file:///a%2520b", "/a%20b"),
            ("file:///100%/x", "/100%/x"),
            ("file:///C:/temp", "C:/temp"),
        ];
        for (uri, path) in cases {
            assert_eq!(of_uri(uri).unwrap(), Path::new(path), "{uri}");
        }
        for uri in ["", "/x", "http://x/y", "file:x", "file://host/x", "file://", "file:///%FF", "file:///a%00b"] {
            assert!(of_uri(uri).is_err(), "{uri}");
        }
    }
}
