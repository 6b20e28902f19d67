"""Which commands a case of each kind goes through, and the command lines of extreme options."""

import re

import mutations

SHORT = [
    part
    for value in ("duration=0.1", "step=0.01", "frame_interval=0.02", "checkpoint_interval=0.04")
    for part in ("--set", "time." + value)
]
SMALL = ["--set", "model.bodies=8"]
BACK_ENDS = ["active-set", "ipopt", "ipopt-unpolished"]


def of_log(file):
    """Two lists: the commands that read a log in this process, and those that start Python or ffmpeg."""
    quick = [
        ["info", file],
        ["check", file, "--csv", "check.csv", "--force"],
        ["playback", file, "--out", "playback.h5", "--force"],
        ["branch", file, "--out", "branch.h5", "--quiet", "--force"],
        ["info", "good.h5", file, "--json"],
        ["export", file, "--out", "tables", "--force"],
        ["view", file, "good.h5", "--out", "replay.html", "--force"],
        ["picture", file, "--out", "picture.png", "--size", "64x48", "--force"],
        ["program", file, "--out", "program.csv", "--force", "--until", "0.08", "--stations", "2", "--times", "3"],
        ["against", file, "film.csv", "--csv", "against.csv", "--force"],
        ["run", "--resume", file, "--quiet"],  # last, as it goes on in the file itself
    ]
    slow = [
        ["movie", file, "--out", "movie.gif", "--size", "64x48", "--quiet", "--force"],
        ["figures", file, "--out", "figures"],
        ["against", file, "film.csv", "--png", "against.png", "--force"],
    ]
    return quick, slow


def of_qps(file, back_end):
    return [["qp", file, "--repeat", "1", "--backend", back_end, "--csv", "qp.csv", "--force"]], []


def of_scene(file, cut, whole):
    """Of a scene with the overrides `cut`; `whole` where it is small enough for smooth motions."""
    quick = [
        ["run", file, "--qp", "active-set", "--quiet", "--out", "run.h5", "--force", *cut],
        ["record-qp", file, "--qp", "active-set", "--quiet", "--out", "qp.h5", "--force", *cut],
        ["mjcf", file, "--out", "mjcf", "--force", *cut],
        ["stress", file, "--cpu-limit", "3", *cut],
    ]
    slow = [
        ["run", file, "--qp", "ipopt", "--quiet", "--out", "run.h5", "--force", *cut],
        ["compare", file, "--out", "compare.h5", "--force", *cut],
        ["sweep", "scene_grid.toml", "--out", "sweep", "--threads", "1", "--quiet"],
    ]
    if whole:
        slow.append(["integrate", file, "--out", "integrate.h5", "--force", *cut])
    return quick, slow


def of_grid(file):
    return [["sweep", file, "--out", "sweep", "--threads", "2", "--quiet"]], []


def of_film(file):
    fit = ["midlines", file, "--scene", "small.toml", "--stations", "3", "--out", "midlines.csv", "--force"]
    quick = [
        [*fit, "--times", "2"],
        [*fit, "--times", "4", "--free-head"],
        ["against", "good.h5", file, "--csv", "against.csv", "--force"],
        ["against", "good.h5", file, "--as-is"],
    ]
    return quick, [["against", "good.h5", file, "--png", "against.png", "--force"]]


def grid_text(scene, cut):
    """A grid of two runs of `scene` with the overrides `cut`, as --set takes them."""
    values = ", ".join('"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"' for value in cut[1::2])
    return f'scene = "{scene}"\nset = [{values}]\n[[axis]]\n"knot.votes" = [1, 2]\n'


# Good commands, whose options are then made extreme.
GOOD = {
    "run": ["run", "table1", "--quiet", "--force", "--qp", "active-set", "--out", "run.h5", *SHORT, *SMALL],
    "branch": ["branch", "good.h5", "--quiet", "--force", "--out", "branch.h5"],
    "scenes": ["scenes"],
    "sweep": ["sweep", "scene_grid.toml", "--threads", "1", "--quiet", "--out", "sweep"],
    "record-qp": ["record-qp", "table1", "--quiet", "--force", "--qp", "active-set", "--out", "qp.h5", *SHORT, *SMALL],
    "qp": ["qp", "good.qp.h5", "--repeat", "1", "--backend", "active-set", "--force"],
    "info": ["info", "good.h5"],
    "check": ["check", "good.h5", "--force"],
    "export": ["export", "good.h5", "--force", "--out", "tables"],
    "view": ["view", "good.h5", "--force", "--out", "replay.html"],
    "figures": ["figures", "good.h5", "--out", "figures"],
    "program": ["program", "good.h5", "--force", "--out", "program.csv", "--until", "0.08", "--stations", "2", "--times", "3"],
    "midlines": ["midlines", "film.csv", "--force", "--scene", "small.toml", "--stations", "3", "--times", "3", "--out", "midlines.csv"],
    "against": ["against", "good.h5", "film.csv", "--force"],
    "specimen": [
        "specimen", "--length", "40", "--mass", "80", "--circumference", "5", "--circumference", "5", "--circumference", "5",
        "--circumference", "4", "--bending", "20", "--bending", "70", "--bending", "40", "--bending", "50", "--twist", "48",
        "--force", "--out", "specimen.toml",
    ],
    "picture": ["picture", "good.h5", "--force", "--size", "64x48", "--out", "picture.png"],
    "movie": ["movie", "good.h5", "--force", "--quiet", "--size", "64x48", "--out", "movie.gif"],
    "mjcf": ["mjcf", "table1", "--force", "--out", "mjcf", *SMALL],
    "compare": ["compare", "table1", "--force", *SHORT, *SMALL],
    "integrate": ["integrate", "table1", "--force", "--out", "integrate.h5", *SHORT, "--set", "model.bodies=3"],
    "playback": ["playback", "good.h5", "--force", "--out", "playback.h5"],
    "stress": ["stress", "table1", "--cpu-limit", "3", *SHORT, *SMALL],
}  # fmt: skip
# Files to write: never one outside the working folder.
OUT = ["", ".", "..", "none/such/x", "a" * 300, "x\x1b[31my", "good.h5", "film.csv", "small.toml", "x", "x.h5", "x.csv", "x.png", "x.gif", "x.mp4"]
VALUES = [
    "", "nan", "inf", "-inf", "1e308", "-1e308", "1e-308", "1e-320", "0", "-0", "-1", "1", "2", "1e12", "1e-12", "99999999999999999999",
    "2147483648", "x", "\x1b[31mx", "a" * 60000, "\udcff", "[[1]]", "=", "a=b", "1/1", "0/0", "64x48", "99999x99999", "-1x-1", "0x0",
    "time.step", "time.step=", "time.step=nan", "start.bend=[]", "title=\"\x07\"", "model.bodies=400000", "/dev/zero", "/etc/passwd", ".", "..",
]  # fmt: skip
# What would rightly take for ever.
PATIENT = {("qp", "--repeat"): {"2147483648", "1e12"}}


def subcommands(help_text):
    return re.findall(r"^  ([a-z][a-z-]*) ", help_text.split("Subcommands:")[1], re.M)


def options(help_text):
    """Options of a subcommand that take a value."""
    return re.findall(r"^ +(?:-\w,)?(--[a-z-]+) (?:TEXT|INT|FLOAT)", help_text, re.M)


def extreme_options(known, random):
    """A command with one to three extreme options; `known` has those of each subcommand."""
    name = str(random.choice(sorted(GOOD)))
    arguments = list(GOOD[name])
    for _ in range(int(random.integers(1, 4))):
        option = str(random.choice(known[name])) if known[name] else None
        if option is None or random.random() < 0.1:
            # No words beside: of several logs, each has its line.
            words = ["--no-such", "--", "--help=1", "-x", "--\x1b[31m"]
            arguments.append(str(random.choice(words if name in ("info", "check") else [*words, "-", "x\x1b[31m", "", "-1"])))
            continue
        writes = option in ("--out", "--csv", "--png", "--scene-out")
        value = str(random.choice(OUT if writes else VALUES))
        if option == "--set" and random.random() < 0.7:
            value = random.choice([a for a in mutations.extreme_overrides(random)[1::2] if not a.startswith("time.")])
            value = value if random.random() < 0.7 else value.split("=")[0] + "=" + str(random.choice(mutations.WORDS))
        if value in PATIENT.get((name, option), ()):
            continue
        places = [k for k, a in enumerate(arguments[:-1]) if a == option]
        if places and random.random() < 0.9:
            arguments[int(random.choice(places)) + 1] = value
        else:
            arguments += [option, value]
    if random.random() < 0.1 and "--force" in arguments:
        arguments.remove("--force")
    return arguments
