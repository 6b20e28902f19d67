"""Puts the page together: python3 page.py hagfish.wasm index.html. One file that needs no other and asks for none."""

import base64
import gzip
import json
import sys
from pathlib import Path

HERE = Path(__file__).parent
VIEW = HERE.parent / "view"
THREE, D3 = Path("/usr/share/javascript/three"), Path("/usr/share/nodejs/d3/dist")
LIBRARIES = {THREE / "three.min.js": "libjs-three", THREE / "examples/js/controls/OrbitControls.js": "libjs-three", D3 / "d3.min.js": "node-d3"}
NOTICE = ("/* three.js and OrbitControls: copyright 2010-2019 three.js authors, MIT licence. D3: copyright 2010-2020 Mike Bostock, "
          "BSD licence. In the simulator: Eigen, MPL 2; {fmt}, toml11 and SIMDe, MIT licence; fast-cpp-csv-parser, BSD licence; "
          "libc++, Apache 2 with LLVM exceptions; wasi-libc and musl, MIT licence. */\n")
SHARED = ["quantities.js", "body.js", "plots.js", "viewer.js"]  # of replay and live


def script(text: str, kind: str = "") -> str:
    if "</script" in text or "<!--" in text:
        raise SystemExit("page: a script would end early: it holds </script or <!--")
    return f"<script{kind}>{text}</script>\n"


def quoted(text: str) -> str:
    return json.dumps(text).replace("<", "\\u003c")


def main(wasm: str, out: str) -> None:
    for file, package in LIBRARIES.items():
        if not file.exists():
            raise SystemExit(f"page: {file} is missing: Debian's {package}")
    replay = {name: (VIEW / name).read_text() for name in ["page.html", "style.css"]}
    packed = base64.b64encode(gzip.compress(Path(wasm).read_bytes(), 9, mtime=0)).decode()
    worker = (HERE / "simulator.js").read_text() + (HERE / "worker.js").read_text()
    scripts = script(NOTICE) + script(packed, ' id="simulator" type="text/plain"') + script(worker, ' id="worker" type="text/plain"')
    for file in LIBRARIES:
        scripts += script(file.read_text(), ' class="replay"')
    for name in SHARED:
        scripts += script((VIEW / name).read_text(), ' class="replay"')
    scripts += script(f"const REPLAY = {quoted(json.dumps(replay))};")
    for file in sorted(HERE.glob("live*.js")):
        scripts += script(file.read_text())
    page = (HERE / "live.html").read_text()
    page = page.replace("/*STYLE*/", replay["style.css"] + (HERE / "live.css").read_text()).replace("<!--SCRIPTS-->", scripts)
    Path(out).write_text(page)
    size = len(gzip.compress(page.encode(), 9))
    print(f"{out}: {len(page.encode()) / 1e6:.2f} MB, {size / 1e6:.2f} MB gzipped")


main(*sys.argv[1:])
