"""A studio that runs, as its page talks to it."""

import base64
import json
import signal
import subprocess
import tempfile
import time
from http.client import HTTPConnection
from pathlib import Path
from urllib.parse import parse_qs, urlsplit


class Studio:
    """`hysteron studio` in a folder. `address` is None where it has ended at once."""

    def __init__(self, hysteron, arguments, folder, before=None):
        self.process = subprocess.Popen(
            [hysteron, "studio", *arguments],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            preexec_fn=before,
        )
        # The address is the first line; nothing, where the studio ends without one.
        line = self.process.stdout.readline().decode().strip()
        self.address = urlsplit(line) if line else None
        tokens = parse_qs(self.address.query).get("token") if line else None
        if line and not tokens:
            self.end(20)
            raise ValueError(f"no address: {line!r}")
        self.token = tokens and tokens[0]

    def call(self, path, body, media="application/json"):
        """The answer to what the page sends, as JSON."""
        where = self.address.netloc
        connection = HTTPConnection(where, timeout=20)
        headers = {"Content-Type": media, "Origin": f"http://{where}"}
        connection.request("POST", f"/{self.token}/api/{path}", body, headers)
        response = connection.getresponse()
        answer = json.loads(response.read())
        connection.close()
        if response.status == 500:
            raise ValueError(f"a defect: {answer}")
        return answer

    def ask(self, **request):
        return self.call("session", json.dumps(request))

    def overview(self):
        return self.ask(request="overview")

    def texts(self):
        """The commands of each fit, as the page shows them."""
        for fit in self.overview()["fits"]:
            for what in ("command", "python", "rust"):
                taken = self.ask(request="take", what=what, fit=fit["id"])
                if "bytes" in taken:
                    yield what, base64.b64decode(taken["bytes"]).decode()
            self.ask(request="drive", fit=fit["id"])

    def quotes(self, folder):
        """Whether a shell that runs the commands makes nothing but calls of hysteron."""
        for what, text in self.texts():
            if what == "command":
                script = f"PATH=\nhysteron() {{ :; }}\n{text}"
                done = subprocess.run(
                    ["/bin/sh", "-c", script], cwd=folder, capture_output=True, check=False
                )
                if done.returncode != 0 or done.stderr:
                    return False
        return not (Path(folder) / "PAYLOAD").exists()

    def end(self, seconds):
        """Ends it as Ctrl-C does: exit code and standard error."""
        if self.address:
            self.process.send_signal(signal.SIGINT)
        try:
            _, stderr = self.process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            _, stderr = self.process.communicate()
        return self.process.returncode, stderr

    @staticmethod
    def session(hysteron, recording):
        """A session with a recording and a fit, as the studio saves it."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "run.csv").write_bytes(recording)
            studio = Studio(
                hysteron, ["run.csv", "--session", "session.json", "--no-open"], folder
            )
            options = {"levels": "3", "bootstrap": "0", "smooth": "1e-6,1e-8"}
            studio.ask(request="fit", options=options, hold_out={"words": "rows:1-20"})
            end = time.monotonic() + 60
            while not studio.overview()["fits"] and time.monotonic() < end:
                time.sleep(0.1)
            studio.end(60)
            return json.loads((Path(folder) / "session.json").read_text())
