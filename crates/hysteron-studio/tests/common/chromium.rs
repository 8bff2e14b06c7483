//! A headless Chromium, driven through its protocol.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use crate::recordings::skip::skipped;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

pub struct Chromium {
    child: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    folder: tempfile::TempDir,
    last: u64,
    /// What pages wrote to their consoles as errors, and what they threw.
    pub errors: Vec<String>,
}

/// A page of the browser.
#[derive(Debug, Clone)]
pub struct Tab(String);

const PATIENCE: Duration = Duration::from_secs(180);

/// The browser, or a line that says why the test is skipped.
pub fn browser() -> Option<Chromium> {
    let found = Chromium::start();
    if found.is_none() {
        assert!(
            std::env::var_os("HYSTERON_NO_SKIP").is_none(),
            "there is no chromium"
        );
        skipped("there is no chromium");
    }
    found
}

/// Pictures of the page for people, in the folder that `HYSTERON_PICTURES` names.
pub fn keep(browser: &mut Chromium, tab: &Tab, name: &str) {
    if let Some(folder) = std::env::var_os("HYSTERON_PICTURES") {
        let picture = browser.picture(tab);
        std::fs::write(PathBuf::from(folder).join(format!("{name}.png")), picture).unwrap();
    }
}

impl Chromium {
    /// `None` where there is none.
    pub fn start() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let mut child = Command::new("chromium")
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
            ])
            .args([
                "--no-first-run",
                "--disable-extensions",
                "--remote-debugging-port=0",
            ])
            .arg(format!(
                "--user-data-dir={}",
                folder.path().join("profile").display()
            ))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .ok()?;
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let found = lines.by_ref().map_while(Result::ok);
        let mut found =
            found.filter_map(|line| Some(line.split_once("listening on ")?.1.trim().to_owned()));
        let address = found.next().unwrap();
        // Its pipe must not fill.
        std::thread::spawn(move || lines.map_while(Result::ok).for_each(drop));
        let (socket, _) = tungstenite::connect(address.as_str()).unwrap();
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(PATIENCE)).unwrap();
        }
        Some(Self {
            child,
            socket,
            folder,
            last: 0,
            errors: Vec::new(),
        })
    }

    fn call(&mut self, tab: Option<&Tab>, method: &str, params: Value) -> Value {
        let answer = self.asked(tab, method, params);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// The whole answer, an error too.
    fn asked(&mut self, tab: Option<&Tab>, method: &str, params: Value) -> Value {
        self.last += 1;
        let mut message = json!({"id": self.last, "method": method, "params": params});
        if let Some(Tab(session)) = tab {
            message["sessionId"] = json!(session);
        }
        self.socket
            .send(Message::text(message.to_string()))
            .unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else {
                continue;
            };
            let answer: Value = serde_json::from_str(&text).unwrap();
            match answer["method"].as_str() {
                Some("Runtime.exceptionThrown") => self.errors.push(text.to_string()),
                Some("Log.entryAdded") if answer["params"]["entry"]["level"] == "error" => {
                    self.errors.push(text.to_string());
                }
                _ => {}
            }
            if answer["id"] == self.last {
                return answer;
            }
        }
    }

    /// Opens an address in a new page of this size.
    pub fn open(&mut self, address: &str, width: u32, height: u32) -> Tab {
        let made = self.call(None, "Target.createTarget", json!({"url": "about:blank"}));
        let attach = json!({"targetId": made["targetId"], "flatten": true});
        let attached = self.call(None, "Target.attachToTarget", attach);
        let tab = Tab(attached["sessionId"].as_str().unwrap().to_owned());
        for domain in ["Page", "Runtime", "Log"] {
            self.call(Some(&tab), &format!("{domain}.enable"), json!({}));
        }
        self.size(&tab, width, height);
        self.call(Some(&tab), "Page.navigate", json!({"url": address}));
        tab
    }

    pub fn size(&mut self, tab: &Tab, width: u32, height: u32) {
        let metrics = json!({"width": width, "height": height, "deviceScaleFactor": 1,
            "mobile": width < 500});
        self.call(Some(tab), "Emulation.setDeviceMetricsOverride", metrics);
    }

    /// Shows a page as `screen` or as `print`.
    pub fn media(&mut self, tab: &Tab, name: &str) {
        let params = json!({"media": name});
        self.call(Some(tab), "Emulation.setEmulatedMedia", params);
    }

    /// Shows a page as where the system is `light` or `dark`.
    pub fn scheme(&mut self, tab: &Tab, name: &str) {
        let features = json!([{"name": "prefers-color-scheme", "value": name}]);
        let params = json!({"features": features});
        self.call(Some(tab), "Emulation.setEmulatedMedia", params);
    }

    /// The value of an expression, once its promise is kept.
    pub fn value(&mut self, tab: &Tab, expression: &str) -> Value {
        self.value_if_there(tab, expression)
            .unwrap_or_else(|| panic!("the page went away: {expression}"))
    }

    /// The same; `None` where the page goes away before that, to load again.
    fn value_if_there(&mut self, tab: &Tab, expression: &str) -> Option<Value> {
        let params = json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.asked(Some(tab), "Runtime.evaluate", params);
        if answer["error"]["message"] == "Inspected target navigated or closed" {
            return None;
        }
        let found = &answer["result"];
        assert!(answer["error"].is_null(), "{expression}: {answer}");
        assert!(found["exceptionDetails"].is_null(), "{expression}: {found}");
        Some(found["result"]["value"].clone())
    }

    /// Waits until an expression is true, through a page that is loaded again.
    pub fn wait(&mut self, tab: &Tab, expression: &str) {
        let begin = Instant::now();
        while self.value_if_there(tab, &format!("Boolean({expression})")) != Some(json!(true)) {
            if begin.elapsed() > PATIENCE {
                let page = self.value(tab, "document.body.innerText");
                panic!("never: {expression}\n{page}\n{:?}", self.errors);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Drops a file on the page, as a hand does.
    pub fn drop_file(&mut self, tab: &Tab, name: &str, text: &str) {
        self.drop_made(tab, name, &json!(text).to_string());
    }

    /// The same with a file that is no text.
    pub fn drop_bytes(&mut self, tab: &Tab, name: &str, bytes: &[u8]) {
        self.drop_made(tab, name, &format!("new Uint8Array({})", json!(bytes)));
    }

    fn drop_made(&mut self, tab: &Tab, name: &str, content: &str) {
        let name = json!(name);
        let code = format!(
            "(() => {{ const data = new DataTransfer(); data.items.add(new File([{content}], {name}));
             document.querySelector('#drop').dispatchEvent(new DragEvent('drop',
             {{dataTransfer: data, bubbles: true, cancelable: true}})); }})()"
        );
        self.value(tab, &code);
    }

    /// Presses the mouse at the first of these points of the page, goes along them, and lets go.
    pub fn drag(&mut self, tab: &Tab, points: &[(f64, f64)]) {
        let mut send = |kind: &str, (x, y): (f64, f64)| {
            let buttons = u8::from(kind != "mouseReleased");
            let params = json!({"type": kind, "x": x, "y": y, "button": "left",
                "buttons": buttons, "clickCount": 1});
            self.call(Some(tab), "Input.dispatchMouseEvent", params);
        };
        send("mousePressed", points[0]);
        // A click does not move: Plotly drops what it hovers over, and takes up to 50 ms to find it
        // again, in which it knows of no click.
        for point in &points[1..] {
            send("mouseMoved", *point);
        }
        send("mouseReleased", points[points.len() - 1]);
    }

    /// Moves the mouse to a point of the page.
    pub fn point(&mut self, tab: &Tab, (x, y): (f64, f64)) {
        let params = json!({"type": "mouseMoved", "x": x, "y": y});
        self.call(Some(tab), "Input.dispatchMouseEvent", params);
    }

    /// Shares of an element's width and height as points of the page. It is scrolled into view.
    pub fn points(&mut self, tab: &Tab, element: &str, shares: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let code = format!(
            "(() => {{ const node = document.querySelector('{element}');
             node.scrollIntoView({{block: 'center'}}); const box = node.getBoundingClientRect();
             return [box.left, box.top, box.width, box.height]; }})()"
        );
        let [left, top, width, height]: [f64; 4] =
            serde_json::from_value(self.value(tab, &code)).unwrap();
        let place = |(x, y): &(f64, f64)| (left + x * width, top + y * height);
        shares.iter().map(place).collect()
    }

    /// A picture of the whole page.
    pub fn picture(&mut self, tab: &Tab) -> Vec<u8> {
        use base64::Engine;
        let params = json!({"format": "png", "captureBeyondViewport": true});
        let found = self.call(Some(tab), "Page.captureScreenshot", params);
        let text = found["data"].as_str().unwrap();
        base64::engine::general_purpose::STANDARD
            .decode(text)
            .unwrap()
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
