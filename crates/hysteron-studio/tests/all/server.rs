//! Who may call the studio, and what it hands out.
#![cfg(feature = "server")]

use crate::common::Studio;

const ASK: &str = "{\"request\":\"overview\"}";

#[test]
fn only_this_page_may_call() {
    let studio = Studio::start(1 << 24, &[]);
    let post = "POST /TOKEN/api/session HTTP/1.1\nContent-Type: application/json\n";
    let own = "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT";
    let status = |head: &str| studio.call(head, ASK.as_bytes()).0;
    assert_eq!(status(&format!("{post}{own}")), 200);
    assert_eq!(
        status(&format!("{post}{own}\nSec-Fetch-Site: same-origin")),
        200
    );
    let refused = [
        // Another name for this machine, as after DNS rebinding, and none at all.
        "Host: evil.example:PORT\nOrigin: http://evil.example:PORT",
        "Host: 127.0.0.1\nOrigin: http://127.0.0.1",
        "Host: 127.0.0.1:PORT.evil.example\nOrigin: http://127.0.0.1:PORT",
        // Another page.
        "Host: 127.0.0.1:PORT\nOrigin: http://evil.example",
        "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:1",
        "Host: 127.0.0.1:PORT\nOrigin: null",
        "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT\nOrigin: http://evil.example",
        "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT\nSec-Fetch-Site: cross-site",
        // No origin where something could change.
        "Host: 127.0.0.1:PORT",
    ];
    for head in refused {
        assert_eq!(status(&format!("{post}{head}")), 403, "{head}");
    }
    // The secret is in every path.
    let mut wrong = studio.token.clone();
    wrong.replace_range(..1, if wrong.starts_with('0') { "1" } else { "0" });
    for path in [
        "/api/session",
        "/x/api/session",
        "//api/session",
        &format!("/{wrong}/api/session"),
    ] {
        let head = post.replace("/TOKEN/api/session", path);
        assert_eq!(status(&format!("{head}{own}")), 403, "{path}");
    }
    for path in [
        "/",
        "/?token=",
        "/?token=0",
        &format!("/?token={wrong}"),
        "/main.js",
        "/x/events",
    ] {
        assert_eq!(
            status(&format!("GET {path} HTTP/1.1\n{own}")),
            403,
            "{path}"
        );
    }
    let (status, head, _) = studio.call(&format!("GET /?token=TOKEN HTTP/1.1\n{own}"), b"");
    assert_eq!(status, 303);
    assert!(
        head.contains(&format!("location: /{}/", studio.token)),
        "{head}"
    );
    studio.end();
}

#[test]
fn the_page_is_whole_and_says_what_it_may() {
    let studio = Studio::start(1 << 24, &[]);
    let get = |path: &str| studio.call(&format!("GET {path} HTTP/1.1\nHost: 127.0.0.1:PORT"), b"");
    let (status, head, page) = get("/TOKEN/");
    assert_eq!(status, 200);
    for part in [
        "content-security-policy: default-src 'none'; script-src 'self';",
        "nosniff",
    ] {
        assert!(head.contains(part), "{head}");
    }
    assert!(
        !page.contains("http:") && !page.contains("https:"),
        "asks the outside"
    );
    let names = page
        .split(['"'])
        .filter(|part| part.ends_with(".js") || part.ends_with(".css"));
    for name in names {
        assert_eq!(get(&format!("/TOKEN/{name}")).0, 200, "{name}");
    }
    studio.end();
}

#[test]
fn no_path_leads_to_the_disk() {
    let folder = tempfile::tempdir().unwrap();
    let named = folder.path().join("run.csv");
    std::fs::write(&named, "a,b\n1,2\n2,3\n1,1\n").unwrap();
    std::fs::write(folder.path().join("secret.csv"), "secret,b\n1,2\n2,3\n").unwrap();
    let studio = Studio::start(1 << 24, &[&named]);
    let paths = [
        "/TOKEN/../../etc/passwd",
        "/TOKEN/..%2f..%2fetc%2fpasswd",
        "/TOKEN/%2e%2e/%2e%2e/etc/passwd",
        "/TOKEN//etc/passwd",
        "/TOKEN/Cargo.toml",
        "/TOKEN/../secret.csv",
        "/TOKEN/run.csv",
        "/TOKEN/style.css%00.js",
        "/TOKEN/api/open/secret.csv",
    ];
    for path in paths {
        let (status, _, body) =
            studio.call(&format!("GET {path} HTTP/1.1\nHost: 127.0.0.1:PORT"), b"");
        assert!(matches!(status, 403..=405), "{path}: {status}");
        assert!(
            !body.contains("root:") && !body.contains("secret"),
            "{path}: {body}"
        );
    }
    // A name that is a path opens what was sent, and nothing else.
    let own = "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT";
    let head = format!("POST /TOKEN/api/open/..%2f..%2fetc%2fpasswd HTTP/1.1\n{own}");
    let (status, _, body) = studio.call(&head, b"x,y\n1,2\n2,4\n1,1\n");
    assert_eq!(status, 200, "{body}");
    assert!(
        body.contains("\"passwd\"") && !body.contains("root:"),
        "{body}"
    );
    // Only the file that was named is read again.
    std::fs::write(&named, "a,b\n1,2\n2,3\n1,1\n2,9\n").unwrap();
    let head = format!("POST /TOKEN/api/reload HTTP/1.1\n{own}");
    let (status, _, body) = studio.call(&head, b"");
    assert_eq!(status, 200);
    assert!(
        body.contains("\"rows\":4") && !body.contains("secret"),
        "{body}"
    );
    studio.end();
}

#[test]
fn an_upload_beyond_the_memory_is_refused() {
    let studio = Studio::start(1 << 20, &[]);
    let own = "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT";
    // 10 GB are announced: refused before the first byte.
    let head = format!("POST /TOKEN/api/open/big.csv HTTP/1.1\n{own}\nContent-Length: 10000000000");
    assert_eq!(studio.call(&head, b"a,b\n").0, 413);
    // Nothing is announced, and no end comes.
    let head = format!(
        "POST /TOKEN/api/open/big.csv HTTP/1.1\n{own}\nTransfer-Encoding: chunked\nX-content-length: none"
    );
    let chunk = [b"10000\r\n".as_slice(), &[b'1'; 0x10000], b"\r\n"].concat();
    assert_eq!(studio.call(&head, &chunk.repeat(64)).0, 413);
    let head = format!("POST /TOKEN/api/open/small.csv HTTP/1.1\n{own}");
    assert_eq!(studio.call(&head, b"a,b\n1,2\n2,3\n").0, 200);
    // What is no request is refused with words.
    let head = format!("POST /TOKEN/api/session HTTP/1.1\n{own}\nContent-Type: application/json");
    for body in [
        "",
        "{",
        "[]",
        "{\"request\":\"rm\"}",
        "{\"request\":\"close\",\"file\":-1}",
    ] {
        let (status, _, text) = studio.call(&head, body.as_bytes());
        assert!(
            status == 500 && text.contains("\"code\":104"),
            "{body}: {status} {text}"
        );
    }
    assert_eq!(
        studio.call(&head, b"{\"request\":\"close\",\"file\":77}").0,
        404
    );
    studio.end();
}

#[test]
fn many_fits_wait_for_one_another() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.csv");
    let row = |n: i32| {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.05).cos();
        format!("{t},{}\n", t + f64::from(n % 7))
    };
    let rows: String = (0..600).map(row).collect();
    std::fs::write(
        &file,
        format!("temperature [degC],displacement [mm]\n{rows}"),
    )
    .unwrap();
    let studio = Studio::start(1 << 28, &[&file]);
    let post = "POST /TOKEN/api/session HTTP/1.1\nContent-Type: application/json";
    let own = "Host: 127.0.0.1:PORT\nOrigin: http://127.0.0.1:PORT";
    let head = format!("{post}\n{own}");
    let session = || -> serde_json::Value {
        let (status, _, text) = studio.call(&head, ASK.as_bytes());
        assert_eq!(status, 200);
        serde_json::from_str(&text).unwrap()
    };
    for _ in 0..3 {
        let fit = b"{\"request\":\"fit\"}";
        let calls: Vec<_> = (0..50).map(|_| studio.call(&head, fit)).collect();
        let refused = calls.iter().filter(|(status, ..)| *status != 200);
        for (status, _, text) in refused.clone() {
            assert!(
                *status == 422 && text.contains("wait for one"),
                "{status} {text}"
            );
        }
        assert!(refused.count() >= 30, "50 fits at once");
        let running = session()["jobs"].as_array().unwrap().clone();
        assert!(running.len() <= 8);
        for job in running {
            let cancel = format!("{{\"request\":\"cancel\",\"job\":{}}}", job["id"]);
            let (status, _, text) = studio.call(&head, cancel.as_bytes());
            // One may have ended by itself.
            assert!(matches!(status, 200 | 404), "{status} {text}");
        }
        let empty = |_: &u32| session()["jobs"].as_array().unwrap().is_empty();
        let wait = std::time::Duration::from_millis(50);
        assert!(
            (0..1200)
                .inspect(|_| std::thread::sleep(wait))
                .any(|n| empty(&n))
        );
    }
    studio.end();
}

/// Connections that bring nothing keep nobody out.
#[test]
fn half_open_connections_do_not_lock_the_owner_out() {
    use std::io::Write;
    let studio = Studio::start(1 << 24, &[]);
    let mut open = Vec::new();
    for n in 0..400 {
        let mut stream = std::net::TcpStream::connect(("127.0.0.1", studio.port)).unwrap();
        if n % 2 == 0 {
            let _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: ");
        }
        open.push(stream);
    }
    let get = "GET /TOKEN/ HTTP/1.1\nHost: 127.0.0.1:PORT";
    assert_eq!(studio.call(get, b"").0, 200);
    // The oldest ones gave way.
    let mut first = &open[0];
    first
        .set_read_timeout(Some(std::time::Duration::from_secs(60)))
        .unwrap();
    let ended = std::io::Read::read(&mut first, &mut [0; 1]);
    assert!(!ended.is_ok_and(|count| count > 0));
    studio.end();
}

/// The page is shown from a page on the disk, and its calls come from itself.
#[test]
fn a_page_on_the_disk_leads_to_the_page_and_calls_nothing() {
    let studio = Studio::start(1 << 24, &[]);
    let from = "Host: 127.0.0.1:PORT\nSec-Fetch-Site: cross-site";
    let shown = "Sec-Fetch-Mode: navigate\nSec-Fetch-Dest: document";
    let status = |head: &str| studio.call(head, b"").0;
    assert_eq!(
        status(&format!("GET /?token=TOKEN HTTP/1.1\n{from}\n{shown}")),
        303
    );
    assert_eq!(
        status(&format!("GET /TOKEN/ HTTP/1.1\n{from}\n{shown}")),
        200
    );
    assert_eq!(
        status(&format!(
            "GET /TOKEN/ HTTP/1.1\n{from}\nSec-Fetch-Dest: iframe"
        )),
        403
    );
    assert_eq!(
        status(&format!("GET /TOKEN/main.js HTTP/1.1\n{from}\n{shown}")),
        403
    );
    assert_eq!(
        status(&format!("GET /TOKEN/api/events HTTP/1.1\n{from}\n{shown}")),
        403
    );
    assert_eq!(status(&format!("GET /0/ HTTP/1.1\n{from}\n{shown}")), 403);
    studio.end();
}

/// Twenty files that come at once, and do not end, take no more than the limit together.
#[test]
fn uploads_share_one_account() {
    use std::io::Write;
    let studio = Studio::start(8 << 20, &[]);
    let head = format!(
        "POST /{0}/api/open/a.csv HTTP/1.1\r\nHost: 127.0.0.1:{1}\r\n\
         Origin: http://127.0.0.1:{1}\r\nContent-Length: 3000000\r\n\r\n",
        studio.token, studio.port
    );
    let upload = || {
        let mut stream = std::net::TcpStream::connect(("127.0.0.1", studio.port)).unwrap();
        stream.write_all(head.as_bytes()).unwrap();
        stream
    };
    let post = "POST /TOKEN/api/session HTTP/1.1\nHost: 127.0.0.1:PORT\n\
                Origin: http://127.0.0.1:PORT\nContent-Type: application/json";
    let taken = || -> u64 {
        let (_, _, text) = studio.call(post, ASK.as_bytes());
        let seen: serde_json::Value = serde_json::from_str(&text).unwrap();
        seen["memory"][0].as_u64().unwrap()
    };
    let open: Vec<_> = (0..20).map(|_| upload()).collect();
    let wait = || std::thread::sleep(std::time::Duration::from_millis(20));
    assert!(
        (0..3000).inspect(|_| wait()).any(|_| taken() == 6_000_000),
        "two have room"
    );
    drop(open);
    assert!(
        (0..3000).inspect(|_| wait()).any(|_| taken() == 0),
        "given back"
    );
    studio.end();
}

#[test]
fn a_session_file_has_one_studio_and_is_not_replaced_when_another_changed_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    let bound = || hysteron_studio::Server::bind(0, 1 << 24).unwrap();
    let missing = bound().keep(&folder.path().join("no/s.json")).unwrap_err();
    assert!(missing.problem.contains("no/s.json"), "{missing}");
    let mut first = bound();
    first.keep(&path).unwrap();
    assert!(path.exists(), "written at once");
    let second = bound().keep(&path).unwrap_err();
    assert!(second.problem.contains("another studio"), "{second}");
    // Another program writes it meanwhile.
    std::fs::write(&path, "mine").unwrap();
    let (stop, stopped) = std::sync::mpsc::channel();
    drop(stop);
    let ended = first.run(stopped).unwrap_err();
    assert!(
        ended.to_string().contains("changed by another program"),
        "{ended}"
    );
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
    // The lock ends with the studio.
    std::fs::remove_file(&path).unwrap();
    bound().keep(&path).unwrap();
}

/// What was opened before it serves is in the session at once, or the studio does not begin.
#[test]
fn files_that_were_opened_first_are_kept_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let [path, run] = ["s.json", "run.csv"].map(|name| folder.path().join(name));
    std::fs::write(&run, "time,a,b\n0,1,2\n1,2,3\n2,1,2\n").unwrap();
    let mut studio = hysteron_studio::Server::bind(0, 1 << 24).unwrap();
    studio.keep(&path).unwrap();
    studio.open(&run).unwrap();
    let (stop, stopped) = std::sync::mpsc::channel();
    let served = std::thread::spawn(move || studio.run(stopped));
    let seen = || std::fs::read_to_string(&path).is_ok_and(|text| text.contains("run.csv"));
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(20);
    while !seen() {
        assert!(std::time::Instant::now() < deadline, "not saved");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    drop(stop);
    served.join().unwrap().unwrap();
}

/// A device may have no end, or no room.
#[cfg(target_os = "linux")]
#[test]
fn a_session_is_not_kept_in_a_device() {
    for device in ["/dev/full", "/dev/zero"] {
        let mut server = hysteron_studio::Server::bind(0, 1 << 24).unwrap();
        assert!(server.keep(std::path::Path::new(device)).is_err());
    }
}
