//! The server against hostile clients: it answers, or drops them, and goes on serving others.

use crate::noise::Noise;
use pantin_tools::serve::{MOST_CONNECTIONS, MOST_HEAD, PATIENCE, Site, Times, serve};
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

const PAGE: &[u8] = b"<!doctype html>page";

/// A server of a page and of a file of some megabytes, for as long as the tests run.
/// Bytes of an answer that the system's buffers between a server and a client that reads nothing do not hold: on Linux a little more than 4 MB.
const LARGE: usize = 16 << 20;

/// The longest that a test waits for what must come: far more than a busy machine takes.
const MOST: Duration = Duration::from_secs(600);

fn server() -> SocketAddr {
    server_with(Times::default())
}

fn server_with(times: Times) -> SocketAddr {
    let mut site = Site::default();
    site.add("/index.html".into(), PAGE.to_vec()).unwrap();
    site.add("/clips/0.ptn".into(), vec![7; 4 << 20]).unwrap();
    site.add("/clips/large.ptn".into(), vec![7; LARGE]).unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap();
    thread::spawn(move || serve(&listener, site, times));
    place
}

fn connect(place: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(place).unwrap();
    stream.set_read_timeout(Some(MOST)).unwrap();
    stream.set_write_timeout(Some(MOST)).unwrap();
    stream
}

/// Sends bytes, and returns all that comes back.
fn talk(place: SocketAddr, request: &[u8]) -> Vec<u8> {
    let mut stream = connect(place);
    // The server may hang up before all was sent.
    let _ = stream.write_all(request);
    let mut answer = vec![];
    match stream.read_to_end(&mut answer) {
        Err(error) if error.kind() != ErrorKind::ConnectionReset => panic!("{error}"),
        _ => answer,
    }
}

fn status(answer: &[u8]) -> String {
    String::from_utf8_lossy(answer).split_whitespace().nth(1).unwrap_or("nothing").to_owned()
}

fn body(answer: &[u8]) -> &[u8] {
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
    &answer[end + 4..]
}

fn serves(place: SocketAddr) {
    let answer = talk(place, format!("GET / HTTP/1.1\r\nHost: {place}\r\n\r\n").as_bytes());
    assert_eq!((status(&answer).as_str(), body(&answer)), ("200", PAGE));
}

#[test]
fn a_packed_site_is_the_site_without_gzip() {
    let mut site = Site::default();
    let files = [
        ("/app.js", &b"script"[..]),
        ("/app.js.br", b"brotli"),
        ("/app.js.gz", b"gzip"),
        ("/clips/a.ptn", b""),
        ("/index.html", PAGE),
    ];
    files.iter().for_each(|(path, bytes)| site.add((*path).into(), bytes.to_vec()).unwrap());
    let packed = site.pack().unwrap();
    let unpacked = Site::unpack(&packed).unwrap();
    for (path, bytes) in files {
        let found = unpacked.file(path).map(|file| &file.bytes[..]);
        assert_eq!(found, (!path.ends_with(".gz")).then_some(bytes), "{path}");
    }
    assert!(Site::unpack(&packed[..packed.len() - 1]).is_err() && Site::unpack(&packed[..5]).is_err());
}

#[test]
fn pages_are_served_and_heads_without_bodies() {
    let place = server();
    serves(place);
    let query = talk(place, b"GET /index.html?clip=walk HTTP/1.0\r\n\r\n");
    assert_eq!(body(&query), PAGE);
    let head = talk(place, b"HEAD /clips/0.ptn HTTP/1.1\r\n\r\n");
    assert_eq!((status(&head).as_str(), body(&head).len()), ("200", 0));
    assert!(String::from_utf8_lossy(&head).contains("Content-Length: 4194304\r\n"));
    assert_eq!(body(&talk(place, b"GET /clips/0.ptn HTTP/1.1\r\n\r\n")).len(), 4 << 20);
}

#[test]
fn unchanged_files_parts_and_codings_are_answered_as_asked() {
    let mut site = Site::default();
    site.add("/index.html".into(), PAGE.to_vec()).unwrap();
    site.add("/index.html.gz".into(), b"gzipped".to_vec()).unwrap();
    site.add("/index.html.br".into(), b"brotli".to_vec()).unwrap();
    site.add("/0.ptn".into(), (0..100).collect()).unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap();
    thread::spawn(move || serve(&listener, site, Times::default()));
    let ask = |path: &str, headers: &str| {
        let answer = talk(place, format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes());
        (status(&answer), String::from_utf8_lossy(&answer).into_owned(), body(&answer).to_vec())
    };
    // The smallest coding that the client takes.
    for (codings, coding, expected) in [
        ("gzip, deflate, br", "br", &b"brotli"[..]),
        ("br;q=0, gzip;q=0.5", "gzip", b"gzipped"),
        ("gzip", "gzip", b"gzipped"),
        ("identity", "", PAGE),
    ] {
        let (status, text, body) = ask("/", &format!("Accept-Encoding: {codings}\r\n"));
        assert_eq!((status.as_str(), &body[..]), ("200", expected), "{codings}");
        assert!(text.contains("Content-Type: text/html") && text.contains("Vary: Accept-Encoding\r\n"), "{text}");
        assert_eq!(text.contains(&format!("Content-Encoding: {coding}\r\n")), !coding.is_empty(), "{text}");
    }
    // What has not changed is not sent again.
    let (_, text, _) = ask("/0.ptn", "");
    let tag = text.lines().find_map(|line| line.strip_prefix("ETag: ")).unwrap().to_owned();
    for tags in [tag.clone(), format!("W/{tag}"), format!("\"other\", {tag}")] {
        let (status, _, body) = ask("/0.ptn", &format!("If-None-Match: {tags}\r\n"));
        assert_eq!((status.as_str(), body.len()), ("304", 0), "{tags}");
    }
    assert_eq!(ask("/0.ptn", "If-None-Match: \"other\"\r\n").0, "200");
    // Parts of a file.
    let all: Vec<u8> = (0..100).collect();
    for (range, expected, told) in [
        ("bytes=10-19", &all[10..20], "bytes 10-19/100"),
        ("bytes=90-", &all[90..], "bytes 90-99/100"),
        ("bytes=-5", &all[95..], "bytes 95-99/100"),
        ("bytes=50-4000", &all[50..], "bytes 50-99/100"),
    ] {
        let (status, text, body) = ask("/0.ptn", &format!("Range: {range}\r\n"));
        assert_eq!((status.as_str(), &body[..]), ("206", expected), "{range}");
        assert!(text.contains(&format!("Content-Range: {told}\r\n")), "{text}");
    }
    assert_eq!(ask("/0.ptn", "Range: bytes=100-\r\n").0, "416");
    for range in ["bytes=9-3", "bytes=0-1,4-5", "lines=1-2", "bytes=x-"] {
        assert_eq!(ask("/0.ptn", &format!("Range: {range}\r\n")).2, all, "{range}");
    }
    assert!(!text.contains("Access-Control"), "{text}");
}

#[test]
fn other_sites_read_only_what_is_shared() {
    let mut site = Site::default();
    site.shared = true;
    site.add("/index.html".into(), PAGE.to_vec()).unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap();
    thread::spawn(move || serve(&listener, site, Times::default()));
    let answer = talk(place, b"GET / HTTP/1.1\r\n\r\n");
    assert!(String::from_utf8_lossy(&answer).contains("Access-Control-Allow-Origin: *\r\n"));
}

#[test]
fn what_was_not_given_is_not_there() {
    let place = server();
    let paths = [
        "/../Cargo.toml",
        "/..%2fCargo.toml",
        "/%2e%2e/%2e%2e/etc/passwd",
        "//etc/passwd",
        "/clips/",
        "/clips/../index.html",
        "/etc/passwd\0.html",
        "/clips\\0.ptn",
        "http://elsewhere/",
        "*",
    ];
    for path in paths {
        let answer = talk(place, format!("GET {path} HTTP/1.1\r\n\r\n").as_bytes());
        assert!(["404", "400"].contains(&status(&answer).as_str()), "{path}: {}", status(&answer));
    }
    serves(place);
}

#[test]
fn a_request_to_another_host_is_forbidden() {
    let place = server();
    let port = place.port();
    let asked = |host: &str| talk(place, format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n").as_bytes());
    for host in ["localhost", "LocalHost", "127.0.0.1", "[::1]"] {
        assert_eq!(status(&asked(&format!("{host}:{port}"))), "200", "{host}");
    }
    let others = ["elsewhere.example".into(), format!("elsewhere.example:{port}"), "localhost:1".into(), "localhost".into()];
    for host in others.into_iter().chain([String::new(), format!("localhost:{port}\r\nHost: elsewhere")]) {
        let answer = asked(&host);
        assert_eq!(status(&answer), "403", "{host}");
        assert!(String::from_utf8_lossy(body(&answer)).contains("the URL that `pantin serve` prints"), "{host}");
    }
}

#[test]
fn another_bound_address_has_any_name() {
    let mut site = Site::default();
    site.add("/index.html".into(), PAGE.to_vec()).unwrap();
    let listener = TcpListener::bind("0.0.0.0:0").unwrap();
    let place = SocketAddr::from(([127, 0, 0, 1], listener.local_addr().unwrap().port()));
    thread::spawn(move || serve(&listener, site, Times::default()));
    assert_eq!(status(&talk(place, b"GET / HTTP/1.1\r\nHost: desk.local\r\n\r\n")), "200");
}

#[cfg(unix)]
#[test]
fn links_out_of_the_site_are_not_served() {
    use std::os::unix::fs::symlink;
    let outside = tempfile::TempDir::new().unwrap();
    fs::create_dir(outside.path().join("clips")).unwrap();
    ["secret", "clips/secret"].iter().for_each(|name| fs::write(outside.path().join(name), b"secret").unwrap());
    let folder = tempfile::TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("index.html"), PAGE).unwrap();
    symlink("index.html", path("inside.html")).unwrap();
    symlink(outside.path().join("secret"), path("leak")).unwrap();
    symlink(outside.path().join("clips"), path("clips")).unwrap();
    fs::create_dir_all(path("docs/decoder")).unwrap();
    ["docs/index.html", "docs/decoder/FORMAT.html"].iter().for_each(|name| fs::write(path(name), name).unwrap());
    symlink(folder.path(), path("docs/around")).unwrap();
    // The site's folder itself may be a link.
    let link = outside.path().join("site");
    symlink(folder.path(), &link).unwrap();
    for site in [folder.path(), &link] {
        let site = Site::read(site).unwrap();
        assert_eq!(site.file("/inside.html").unwrap().bytes, PAGE);
        assert!(site.file("/leak").is_none() && site.file("/clips/secret").is_none());
        // Folders of the site are served, with their pages, and links to folders are not followed.
        assert_eq!(site.file("/docs/").unwrap().bytes, b"docs/index.html");
        assert_eq!(site.file("/docs/decoder/FORMAT.html").unwrap().bytes, b"docs/decoder/FORMAT.html");
        assert!(site.file("/docs/decoder/").is_none() && site.file("/docs/around/index.html").is_none());
    }
}

/// A folder with a page, and with what `name` says in `content`.
fn folder(files: &[(&str, &[u8])]) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("pantin-serve-{}-{}", std::process::id(), files.len()));
    fs::create_dir_all(folder.join("clips")).unwrap();
    for (name, content) in files {
        fs::write(folder.join(name), content).unwrap();
    }
    folder
}

#[test]
fn a_site_is_a_folder_with_a_page_and_clips_are_clips() {
    let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.ptn");
    let with = folder(&[("index.html", PAGE), ("clips.json", b"[]"), ("clips/own.ptn", b"own"), ("text.ptn", b"no clip")]);
    let mut site = Site::read(&with).unwrap();
    assert_eq!(site.file("/clips/own.ptn").unwrap().bytes, b"own");
    site.show(std::slice::from_ref(&walk)).unwrap();
    assert!(site.file("/clips/own.ptn").is_none());
    assert_eq!(site.file("/clips/0.ptn").unwrap().bytes, fs::read(&walk).unwrap());
    let list = format!(r#"[{{"bytes":{},"file":"clips/0.ptn","name":"walk"}}]"#, fs::metadata(&walk).unwrap().len());
    assert_eq!(site.file("/clips.json").unwrap().bytes, list.as_bytes());
    let message = |outcome: anyhow::Result<()>| format!("{:#}", outcome.unwrap_err());
    assert!(message(site.show(&[with.join("text.ptn")])).contains("text.ptn: not a pantin clip; `pantin convert` makes clips"));
    assert!(message(site.show(&[with.join("absent.ptn")])).contains("absent.ptn: cannot be read"));
    let without = folder(&[("clips.json", b"[]")]);
    assert!(message(Site::read(&without).map(drop)).contains("`cargo xtask web` builds one"));
    [with, without].iter().for_each(|folder| fs::remove_dir_all(folder).unwrap());
}

#[test]
fn other_methods_are_refused() {
    let place = server();
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "CONNECT", "TRACE", "get", "PRI"] {
        let answer = talk(place, format!("{method} / HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc").as_bytes());
        assert_eq!(status(&answer), "405", "{method}");
        assert!(String::from_utf8_lossy(&answer).contains("\r\nAllow: GET, HEAD\r\n"));
    }
    serves(place);
}

#[test]
fn malformed_requests_get_an_answer_and_harm_nobody() {
    let place = server();
    let mut noise = Noise(1);
    let noise: Vec<u8> = std::iter::repeat_with(|| noise.below(256) as u8).take(3000).collect();
    let requests: [&[u8]; 9] = [
        b"nonsense\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"GET / HTTP/1.1\r\n: no name\r\n\r\n",
        b"GET / HTTP/1.1\r\nA\0B: c\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        b"\xff\xfe\xfd\r\n\r\n",
        b"GET /\xff\xfe HTTP/1.1\r\n\r\n\r\n",
        &noise,
    ];
    for request in requests {
        let answer = talk(place, request);
        assert!(["400", "404", "408"].contains(&status(&answer).as_str()), "{:?}: {}", request.escape_ascii(), status(&answer));
    }
    serves(place);
}

#[test]
fn heads_without_end_are_cut_off() {
    let place = server();
    let long = [&b"GET / HTTP/1.1\r\nA: "[..], &vec![b'a'; 10 * MOST_HEAD]].concat();
    assert!(["431", "nothing"].contains(&status(&talk(place, &long)).as_str()));
    let many = [&b"GET / HTTP/1.1\r\n"[..], &b"A: b\r\n".repeat(500), b"\r\n"].concat();
    assert_eq!(status(&talk(place, &many)), "431");
    let path = format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(2 * MOST_HEAD));
    assert!(["431", "nothing"].contains(&status(&talk(place, path.as_bytes())).as_str()));
    serves(place);
}

#[test]
fn slow_and_silent_clients_are_left_and_keep_nobody_waiting() {
    let place = server();
    let mut silent: Vec<TcpStream> = (0..MOST_CONNECTIONS - 2).map(|_| connect(place)).collect();
    serves(place);
    // A byte now and then does not make a head endless.
    let begun = Instant::now();
    let mut slow = connect(place);
    let mut answer: Vec<u8> = vec![];
    while begun.elapsed() < MOST {
        let _ = slow.write_all(b"G");
        thread::sleep(Duration::from_millis(200));
        slow.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
        let mut piece = [0; 512];
        match slow.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => answer.extend_from_slice(&piece[..count]),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(_) => break,
        }
    }
    assert!(begun.elapsed() < MOST, "it is not left");
    assert!(["400", "408", "nothing"].contains(&status(&answer).as_str()), "{}", status(&answer));
    for stream in &mut silent {
        let mut answer = vec![];
        stream.read_to_end(&mut answer).unwrap();
        assert_eq!(status(&answer), "408");
    }
    serves(place);
}

/// A client that asks for more than the buffers between us hold, and reads none of it.
fn greedy(place: SocketAddr) -> TcpStream {
    let mut stream = connect(place);
    stream.write_all(b"GET /clips/large.ptn HTTP/1.1\r\n\r\n").unwrap();
    stream
}

/// The status that another client gets.
fn answered(place: SocketAddr) -> String {
    let mut another = connect(place);
    let _ = another.write_all(b"GET / HTTP/1.1\r\nConnection: close\r\n\r\n");
    let mut answer = vec![];
    let _ = another.read_to_end(&mut answer);
    status(&answer)
}

#[test]
fn more_clients_than_there_may_be_are_told_so() {
    let place = server_with(Times { request: MOST, answer: MOST });
    let mut all: Vec<TcpStream> = (0..MOST_CONNECTIONS).map(|_| greedy(place)).collect();
    let begun = Instant::now();
    // A busy machine may have taken a place from one whose request it had not read yet: another takes it.
    while answered(place) != "503" {
        assert!(begun.elapsed() < MOST, "nobody is refused");
        all.push(greedy(place));
    }
    drop(all);
}

#[test]
fn clients_that_read_nothing_go() {
    let short = Duration::from_millis(500);
    let place = server_with(Times { request: short, answer: short });
    // On a busy machine it takes longer until the server has written what the buffers hold.
    let left = (0..8).any(|turn| {
        let mut stream = greedy(place);
        thread::sleep(2 * short * (1 << turn));
        let mut answer = vec![];
        let _ = stream.read_to_end(&mut answer);
        answer.len() < LARGE
    });
    assert!(left, "the whole answer came after two minutes in which none of it was read");
    serves(place);
}

#[test]
fn the_command_prints_its_address_and_serves_there() {
    let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.ptn");
    let site = folder(&[("index.html", PAGE), ("a", b""), ("b", b"")]);
    let pantin = || {
        let mut pantin = Command::new(env!("CARGO_BIN_EXE_pantin"));
        pantin.arg("serve").args(["--port", "0"]).arg("--site").arg(&site).stdout(Stdio::piped()).stderr(Stdio::piped());
        pantin
    };
    let mut running = pantin().arg(&walk).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(running.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.strip_prefix("http://").and_then(|rest| rest.split('/').next()).unwrap();
    assert!(address.starts_with("127.0.0.1:"), "{line}");
    serves(address.parse().unwrap());
    assert_eq!(body(&talk(address.parse().unwrap(), b"GET /clips/0.ptn HTTP/1.1\r\n\r\n")), fs::read(&walk).unwrap());
    running.kill().unwrap();
    running.wait().unwrap();
    let refused = pantin().arg(site.join("a")).output().unwrap();
    assert!(!refused.status.success() && refused.stdout.is_empty());
    assert!(String::from_utf8_lossy(&refused.stderr).contains("the clip is truncated"), "{refused:?}");
    fs::remove_dir_all(site).unwrap();
}

#[test]
fn clients_that_drip_bytes_after_their_answer_keep_nobody_waiting() {
    let place = server();
    let mut dripping: Vec<TcpStream> = (0..MOST_CONNECTIONS).map(|_| connect(place)).collect();
    for stream in &mut dripping {
        stream.write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
    }
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE / 2 {
        dripping.iter_mut().for_each(|stream| drop(stream.write_all(b"x")));
        thread::sleep(Duration::from_millis(100));
    }
    serves(place);
    drop(dripping);
}

#[test]
fn hundreds_of_clients_that_drip_their_requests_leave_places_to_others() {
    // Without a place that is taken from one of them, nobody else would be served.
    let place = server_with(Times { request: MOST, answer: MOST });
    let mut dripping: Vec<(TcpStream, Vec<u8>)> = Vec::new();
    let (begun, mut served, mut statuses) = (Instant::now(), 0, std::collections::BTreeSet::new());
    let (done, stop) = std::sync::mpsc::channel();
    let other = thread::spawn(move || {
        thread::sleep(Duration::from_secs(1));
        for _ in 0..5 {
            serves(place);
            done.send(()).unwrap();
        }
    });
    while served < 5 && begun.elapsed() < MOST {
        // Those that were refused come again.
        while dripping.len() < 300 {
            let stream = connect(place);
            stream.set_nonblocking(true).unwrap();
            dripping.push((stream, Vec::new()));
        }
        dripping.retain_mut(|(stream, answer)| {
            if answer.is_empty() {
                let _ = stream.write(b"G");
            }
            let mut piece = [0; 512];
            loop {
                match stream.read(&mut piece) {
                    Ok(0) => break,
                    Ok(count) => answer.extend_from_slice(&piece[..count]),
                    Err(error) if error.kind() == ErrorKind::WouldBlock => return true,
                    Err(error) => panic!("{error}"),
                }
            }
            statuses.insert(status(answer));
            false
        });
        served += stop.try_iter().count();
        thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(served, 5);
    other.join().unwrap();
    assert!(
        !statuses.is_empty() && statuses.iter().all(|status| ["408", "503", "400"].contains(&status.as_str())),
        "{statuses:?}"
    );
}

#[test]
fn clients_that_take_an_answer_byte_by_byte_keep_nobody_waiting() {
    let answer = Duration::from_secs(1);
    let place = server_with(Times { request: MOST, answer });
    let mut slow: Vec<TcpStream> = (0..MOST_CONNECTIONS).map(|_| connect(place)).collect();
    for stream in &mut slow {
        stream.write_all(b"GET /clips/large.ptn HTTP/1.1\r\n\r\n").unwrap();
    }
    let (begun, mut piece) = (Instant::now(), vec![0; 2048]);
    // At this pace the whole answer would take an hour.
    while answered(place) != "200" || begun.elapsed() < answer {
        assert!(begun.elapsed() < MOST, "they keep their places");
        for stream in &mut slow {
            let _ = stream.read(&mut piece);
        }
        thread::sleep(Duration::from_millis(500));
    }
}
