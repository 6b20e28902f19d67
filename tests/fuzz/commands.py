"""Which commands a case of each kind goes through, and the command lines of extreme options."""

import re

import mutations

SHORT = [part
    for value in ("duration=0.1", "step=0.01", "frame_interval=0.02") for part in ("--set", "time." + value)]
SMALL = ["--set", "model.bodies=8"]


# Good values of arguments and options, by the names that help gives them; what is not here is left out.
ARGUMENTS = {"LOG": "good.h5", "SCENE": "table1", "GRID": "scene_grid.toml", "SET": "good.qp.h5", "FILM": "film.csv", "KNOT": "7_7"}
OPTIONS = {
    "--force": [], "--quiet": [], "--qp": ["active-set"], "--backend": ["active-set"], "--repeat": ["1"],
    "--threads": ["1"], "--cpu-limit": ["3"], "--size": ["64x48"], "--stations": ["3"], "--times": ["3"],
    "--scene": ["small.toml"], "--length": ["40"], "--mass": ["80"],
    "--circumference": ["5,5,5,4"], "--bending": ["20,70,40,50"], "--twist": ["48"],
}  # fmt: skip
ENDINGS = {"picture": ".png", "movie": ".gif"}  # of --out
BESIDE = {"program": ["--until", "0.08"], "integrate": ["--set", "model.bodies=3"], "design": ["--budget", "1e-6"],
          "branch": ["--time", "0.04"], "mujoco-run": ["--set", "script.kind=none"], "run": ["--out", "run.h5"],
          "compare": ["--out", "compare.h5"]}


class Command:
    """A subcommand as its help has it: a good command line, and which options take values."""

    def __init__(self, name, help_text):
        positionals, _, options = help_text.partition("Options:\n")
        places = re.findall(r"^  ([A-Z]+) TEXT", positionals.partition("Positionals:")[2], re.M)
        self.valued = re.findall(r"^ +(?:-\w,)?(--[a-z-]+) (?:TEXT|INT|FLOAT)", options, re.M)
        self.reads_log = "LOG" in places
        self.good = [name, *(ARGUMENTS[place] for place in places)]
        for option, rest in re.findall(r"^ +(?:-\w,)?(--[a-z-]+)(.*)$", options, re.M):
            if option == "--out" and "REQUIRED" in rest:
                self.good += ["--out", name + ENDINGS.get(name, "")]
            elif option == "--set" and "SCENE" in places:
                self.good += [*SHORT, *SMALL]
            elif option in OPTIONS:
                self.good += [option, *OPTIONS[option]]
            elif "REQUIRED" in rest:
                raise ValueError(f"tests/fuzz/commands.py has no {option}, which {name} needs")
        self.good += BESIDE.get(name, [])


# What a file goes through beside the good line of each command that takes it.
MORE = {
    "LOG": ["check FILE --csv check.csv", "info good.h5 FILE --json", "view FILE good.h5 --out replay.html",
            "against FILE film.csv --csv against.csv", "against FILE film.csv --png against.png",
            "run --resume FILE --quiet"],  # last, as it goes on in the file itself
    "FILM": ["midlines FILE --scene small.toml --stations 3 --out midlines.csv --times 4 --free-head",
             "against good.h5 FILE --csv against.csv", "against good.h5 FILE --as-is",
             "against good.h5 FILE --png against.png"],
    "SET": ["qp FILE --repeat 1 --backend ipopt --csv qp.csv", "qp FILE --repeat 1 --backend ipopt-unpolished"],
    "SCENE": ["run FILE --qp ipopt --quiet --out run.h5", "sweep scene_grid.toml --out sweep --threads 1 --quiet"],
    "GRID": [],
}
SLOW = ("figures", "movie", "compare", "integrate", "sweep")  # start Python or ffmpeg, or take long
LEFT_OUT = ("sure", "mujoco-run")  # of scenes: thirty runs, and runs of MuJoCo


def is_slow(line):
    return line[0] in SLOW or "--png" in line or (line[0] == "run" and "ipopt" in line)


def through(place, file, known, settings=(), whole=True):
    """Two lists: quick and slow commands that take `file` in a place of the help. Smooth motions take minutes of as
    many bodies as a file may ask for: they are left out where it is not `whole`."""
    left_out = (*LEFT_OUT, *(() if whole else ("integrate",))) if place == "SCENE" else ()
    good = [command.good for name, command in known.items() if ARGUMENTS[place] in command.good and name not in left_out]
    lines = [[file if word == ARGUMENTS[place] else word for word in line] for line in good]
    for line in MORE[place]:
        words = [file if word == "FILE" else word for word in line.split()]
        lines.append([*words, *(["--force"] if "--force" in known[words[0]].good and "--resume" not in words else [])])
    if place == "SCENE":
        lines = [[word for k, word in enumerate(line) if "--set" not in line[max(0, k - 1):k + 1]] for line in lines]
        lines = [line if line[0] == "sweep" else [*line, *settings] for line in lines]
        lines.sort(key=lambda line: line[0] != "run")  # which says whether the reader takes the scene
    quick, slow = [line for line in lines if not is_slow(line)], [line for line in lines if is_slow(line)]
    return (quick, slow) if quick else (slow, [])


def grid_text(scene, cut):
    """A grid of two runs of `scene` with the overrides `cut`, as --set takes them."""
    values = ", ".join('"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"' for value in cut[1::2])
    return f'scene = "{scene}"\nset = [{values}]\n[[axis]]\n"knot.votes" = [1, 2]\n'


# Files to write: never one outside the working folder.
OUT = ["", ".", "..", "none/such/x", "a" * 300, "x\x1b[31my", "good.h5", "film.csv", "small.toml", "x", "x.h5", "x.csv",
       "x.png", "x.gif", "x.mp4"]
VALUES = [
    *("nan inf -inf 1e308 -1e308 1e-308 1e-320 0 -0 -1 1 2 1e12 1e-12 99999999999999999999 2147483648 x [[1]] = a=b "
      "1/1 0/0 64x48 99999x99999 -1x-1 0x0 time.step time.step= time.step=nan start.bend=[] model.bodies=400000 "
      "/dev/zero /etc/passwd . ..").split(), "", "\x1b[31mx", "a" * 60000, "\udcff", 'title="\x07"']
# What would rightly take for ever.
PATIENT = {("qp", "--repeat"): {"2147483648", "1e12"},
           ("design", "--budget"): {"2147483648", "1e12", "1e308", "99999999999999999999"}}


def subcommands(help_text):
    return re.findall(r"^  ([a-z][a-z-]*) ", help_text.split("Subcommands:")[1], re.M)


def extreme_options(known, random):
    """A command with one to three extreme options; `known` has each subcommand."""
    name = str(random.choice(sorted(known)))
    arguments = list(known[name].good)
    for _ in range(int(random.integers(1, 4))):
        option = str(random.choice(known[name].valued)) if known[name].valued else None
        if option is None or random.random() < 0.1:
            # No words beside: of several logs, each has its line.
            words = ["--no-such", "--", "--help=1", "-x", "--\x1b[31m"]
            words += [] if name in ("info", "check") else ["-", "x\x1b[31m", "", "-1"]
            arguments.append(str(random.choice(words)))
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
