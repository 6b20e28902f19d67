"""Gives the program hostile, damaged and extreme input, through every subcommand. See tests/fuzz.sh."""

import argparse
import collections
import multiprocessing
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "experiments/docs/reference"))  # of mutations

import commands
import mutations

LATE = 10  # s of CPU time; what takes longer counts as hung
NAMED_SHARE = 0.4  # of the time at most, for the named cases
KINDS = {"log flip": 150, "qp flip": 50, "log change": 3, "qp change": 2, "toml": 2, "grid": 1, "csv": 1, "film": 1,
         "scene": 10, "options": 10}  # and their shares
CASES = 23000
WHOLE = {"log flip": 60, "qp flip": 60}  # one in so many goes through all quick commands, the others through one each
SLOW = {"log flip": 150}  # commands that draw, compare or start others take part in one of so many cases;
SLOW_OF_OTHERS = 10  # of other kinds
PATIENCE = {"figures": 60, "integrate": 600, "compare": 60}  # s: Python and the program again; many steps by design
BASES = {
    "rest.h5": ["run", "muscles", *commands.SMALL],
    "slide.h5": ["run", "SCENES/knot_into_head.toml"],
    "box.qp.h5": ["record-qp", "SCENES/redundant.toml", *commands.SMALL],
    "primal.qp.h5": ["record-qp", "SCENES/redundant.toml", "--primal", *commands.SMALL],
}
BRIEFLY = ["--qp", "active-set", "--quiet", *commands.SHORT, "--force", "--out"]


def is_clean(text):
    return all(c in "\n\t" or (ord(c) >= 32 and not 127 <= ord(c) < 160) for c in text)


def fault(status, output, error):
    """What is wrong with how a command ended, or nothing."""
    error = error.decode("utf-8", "replace")
    # Memory refused is as good as none: what the program then says is what counts.
    error = re.sub("==[0-9]+==WARNING: AddressSanitizer failed to allocate .*\\n", "", error)
    text = output.decode("utf-8", "replace") + error
    if status == "late":
        return "took longer than 10 s"
    if "Sanitizer" in text and "libhdf5" in text:
        return None  # HDF5's own, in a process that may crash
    if status not in ("0", "1", "2", "3"):
        return "ended with " + status + " " + " ".join(line for line in text.split("\n") if "ERROR" in line)[:300]
    for word in ("internal error", "runtime error:", "Sanitizer", "Press Enter", "Traceback"):
        if word in text:
            return next(line for line in text.split("\n") if word in line)[:300]
    if not is_clean(text):
        return "printed control characters"
    if len(text) > 100000 or max(map(len, text.split("\n"))) > 5000:
        return "printed too much"
    crashed = error.endswith("memory is short\n")  # of HDF5, perhaps when the command had had its say
    if status == "2" and (error.count("\n") != 1 or not error.strip()) and not crashed:
        return f"{error.count(chr(10))} lines of what is wrong with its input: {error[-300:]!r}"
    if status == "1" and not text.strip():
        return "failed and does not say why"
    return None


class Server:
    """The commands, run by the fork server in a folder of its own."""

    def __init__(self, program, folder):
        folder.mkdir()
        self.folder = folder
        environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
        environment["ASAN_OPTIONS"] = "detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=8000"
        environment["UBSAN_OPTIONS"] = "halt_on_error=1:print_stacktrace=1"
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "encoding": "utf-8", "errors": "surrogateescape"}
        self.process = subprocess.Popen([program], cwd=folder, env=environment, **pipes)

    def run(self, arguments, seconds=LATE):
        self.process.stdin.write("\t".join([str(seconds), *arguments]) + "\n")
        self.process.stdin.flush()
        status = self.process.stdout.readline().strip()
        return status, *((self.folder / name).read_bytes() for name in ("out.txt", "error.txt"))


BASIS = "shape,station (cm),bend_y (1),bend_z (1),twist (1)\n" + "".join(
    f"{shape},{station},{shape * station / 42.4},{0.5 - shape},{0.1}\n"
    for shape in (1, 2) for station in (0, 10.6, 21.2, 31.8, 42.4))
BASIS_SCENE = """base = "few_numbers"
[controller.reduced_basis]
frame = "body"
cosines = 0
file = "case.csv"
"""
PROGRAM_SCENE = 'base = "living_overhand"\n[script]\nprogram = "case.csv"\n'
GRID = """scene = "table1"
keep = "failed"
seeds = 2
[[axis]]
"model.limit_scale" = { from = 0.75, to = 1.2, count = 2 }
[[axis]]
"model.bending_stiffness" = { from = 40, to = 4000, count = 2, scale = "log" }
"drag.normal" = [0.1, 10]
[[axis]]
controller.law = ["paper", "all_contacts"]
start.noise_deg = [0.1, 1e-3]
"""


def film_text(log):
    """A film of a log: every third of its bodies' centres."""
    lines = ["time_s,s_cm,x_cm,y_cm,z_cm"]
    with h5py.File(log) as file:
        place = np.cumsum(file["model/length"][()]) - file["model/length"][()] / 2
        for time_s, points in zip(file["trajectory/time"][()], file["trajectory/position"][()]):
            for s, point in list(zip(place, points))[::3]:
                lines.append(",".join(f"{value:.6g}" for value in (time_s, s, *point)))
    return "\n".join(lines) + "\n"


def known_commands(server):
    """Every subcommand by its name."""
    told = lambda *arguments: server.run([*arguments, "--help"])[1].decode()
    return {name: commands.Command(name, told(name)) for name in commands.subcommands(told())}


class Worker:
    def __init__(self, number, options, folder, bases, texts):
        self.number = number
        self.random = np.random.default_rng([options.seed, number])
        self.keep = pathlib.Path(options.keep)
        self.folder = folder / f"w{number}"
        self.server = Server(options.server, self.folder)
        self.bases = {name: path.read_bytes() for name, path in bases.items()}
        self.paths = bases
        self.blocks = {name: mutations.used_blocks(data) for name, data in self.bases.items()}
        self.texts = texts
        self.source = pathlib.Path(options.source)
        self.program = (self.source / "data/programs/overhand.csv").read_text()
        self.film = film_text(bases["whole_slide.h5"])
        self.cases = dict.fromkeys(["named", *KINDS], 0)
        self.seen = collections.Counter()  # of (subcommand, how it ended)
        self.longest = {}  # s of wall time, by subcommand
        self.faults = []
        self.known = known_commands(self.server)
        self.lay_out()

    def lay_out(self):
        """The good files that commands take beside the case."""
        shutil.copyfile(self.paths["whole_rest.h5"], self.folder / "good.h5")
        shutil.copyfile(self.paths["box.qp.h5"], self.folder / "good.qp.h5")
        (self.folder / "film.csv").write_text(self.film)
        (self.folder / "small.toml").write_text('base = "living_overhand"\n[model]\nbodies = 20\n')
        (self.folder / "scene_grid.toml").write_text(commands.grid_text("table1", commands.SHORT + commands.SMALL))
        for file in (self.source / "experiments/results/stability/scenes").glob("*.toml"):
            (self.folder / file.name).write_text(re.sub(r'"[./]*/data/', '"', file.read_text()))
        for folder in ("programs", "specimens"):
            shutil.copytree(self.source / "data" / folder, self.folder / folder, dirs_exist_ok=True)

    def base(self, kind):
        names = [n for n in self.bases if n.endswith(".qp.h5") == kind.startswith("qp")]
        return names[self.random.integers(len(names))]

    def make(self, kind):
        """A case of `kind` as a file, and overrides of it; nothing where a change does not apply."""
        file = self.folder / ("case.h5" if kind.split()[0] in ("log", "qp") else "case.toml")
        cut = commands.SHORT + commands.SMALL
        if kind == "csv":
            shapes = self.random.random() < 0.3
            damaged = mutations.mutated_csv(BASIS if shapes else self.program, self.random)
            (self.folder / "case.csv").write_bytes(damaged)
            file.write_text(BASIS_SCENE if shapes else PROGRAM_SCENE)
        elif kind == "film":
            file = self.folder / "case.csv"
            file.write_bytes(mutations.mutated_csv(self.film, self.random))
        elif kind == "scene":
            scene = mutations.EXTREME_SCENES[self.random.integers(len(mutations.EXTREME_SCENES))]
            return scene, mutations.extreme_overrides(self.random, any_bodies="." not in scene)
        elif kind == "grid":
            text = f'set = [{", ".join(repr(v) for v in cut[1::2])}]\n' + mutations.mutated_text(GRID, self.random)
            file.write_bytes(text.encode("utf-8", "surrogateescape"))
        elif kind == "toml":
            text = mutations.mutated_text(self.texts[self.random.integers(len(self.texts))], self.random)
            if text.count("circumference") and "[model]" not in text:
                (self.folder / "case_specimen.toml").write_bytes(text.encode("utf-8", "surrogateescape"))
                text = 'base = "muscles"\nspecimen = "case_specimen.toml"\n'
            file.write_bytes(text.encode("utf-8", "surrogateescape"))
        elif kind.endswith("flip"):
            base = self.base(kind)
            file.write_bytes(mutations.flipped(self.bases[base], self.blocks[base], self.random))
        else:
            change = lambda log: mutations.structured(log, self.random)
            return (file.name, cut) if mutations.changed_log(self.paths[self.base(kind)], change, file) else None
        return file.name, cut

    def commands_for(self, kind, file, cut):
        """The commands that this case goes through."""
        count = self.cases[kind if kind in self.cases else "named"]
        if kind == "options":
            return [commands.extreme_options(self.known, self.random)]
        place = {"log": "LOG", "qp": "SET", "grid": "GRID", "film": "FILM"}.get(kind.split()[0], "SCENE")
        quick, slow = commands.through(place, file, self.known, cut, whole=kind == "scene" and "." not in file)
        if place == "SCENE":
            (self.folder / "scene_grid.toml").write_text(commands.grid_text(file, cut))
        every = SLOW.get(kind, SLOW_OF_OTHERS)
        slow = slow[count // every % len(slow)] if slow and count % every == 0 else None
        if count % WHOLE.get(kind, 1) != 0:
            quick = [quick[count % len(quick)]] if slow is None else []
        return ([slow] if slow else []) + quick

    def take(self, kind, name, file, cut=()):
        """Whether the first command accepted the case."""
        accepted = None
        # As they are now: to go on with a log changes it.
        files = [path for path in self.folder.glob("case*") if path.is_file()]
        inputs = {path.name.replace("case", name, 1): path.read_bytes() for path in files}
        kept = self.keep / f"{name}{pathlib.Path(file).suffix}" if file.startswith("case") else file
        for arguments in self.commands_for(kind, file, cut):
            shutil.rmtree(self.folder / "sweep", ignore_errors=True)
            begin = time.monotonic()
            status, *told = self.server.run(arguments, PATIENCE.get(arguments[0], LATE))
            took = time.monotonic() - begin
            self.longest[arguments[0]] = max(took, self.longest.get(arguments[0], 0))
            self.seen[arguments[0], status] += 1
            accepted = status != "2" if accepted is None else accepted
            found = fault(status, *told) or self.left_behind(status)
            if found:
                shown = " ".join(shlex.quote(a if a != file else str(kept)) for a in arguments)
                self.faults.append(f"{name}: {found}\n    hagfish {shown}".encode("utf-8", "backslashreplace").decode())
                print(self.faults[-1], flush=True)
                self.keep.mkdir(parents=True, exist_ok=True)
                for kept_as, data in inputs.items():
                    (self.keep / kept_as).write_bytes(data)
        self.cases[kind if kind in self.cases else "named"] += 1
        return accepted

    def left_behind(self, status):
        """What a command left that it must not: after bad input, no part of what it would have written."""
        found = None
        for path in self.folder.iterdir():
            if path.name == "MUJOCO_LOG.TXT" or (".part" in path.name and status == "2"):
                found = "wrote " + path.name
            if path.name == "MUJOCO_LOG.TXT" or ".part" in path.name:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        return found

    def named(self, number, workers, seed, end):
        """This worker's share of them, in an order by the seed, until the time is over."""
        cases = list(mutations.NAMED.items())
        np.random.default_rng(seed).shuffle(cases)
        for name, change in cases[number::workers]:
            for base in ("rest.h5", "slide.h5"):
                if time.monotonic() > end:
                    return
                file = self.folder / "case.h5"
                if mutations.changed_log(self.paths[base], change, file):
                    self.take("log", f"{name}_{base[:-3]}", file.name)

    def one(self, kind, count):
        if kind == "options":
            self.lay_out()
            made = ("", ())
        else:
            made = self.make(kind)
        if made is None:
            return
        name = f"{kind.replace(' ', '_')}_{self.number}_{count}"
        accepted = self.take(kind, name, *made)
        if kind == "scene" and not accepted:
            self.cases[kind] -= 1  # those count that the reader takes


def work(number, options, folder, bases, texts, results):
    begin = time.monotonic()
    end = begin + 60 * options.minutes
    worker = Worker(number, options, folder, bases, texts)
    try:
        worker.named(number, options.jobs, options.seed, begin + NAMED_SHARE * (end - begin))
        go_through_kinds(worker, options, end)
    finally:  # what was found so far
        results.put((worker.cases, worker.seen, worker.longest, worker.faults))


def go_through_kinds(worker, options, end):
    tries, cases = 0, options.cases / options.jobs
    while time.monotonic() < end and sum(worker.cases.values()) < cases:
        # The kind that is furthest behind, so that a short run has some of each.
        worker.one(min(KINDS, key=lambda kind: worker.cases[kind] / KINDS[kind]), tries)
        tries += 1


def make_bases(options, folder):
    server = Server(options.server, folder / "bases")
    scenes = pathlib.Path(options.source) / "experiments/results/stability/scenes"
    bases = {}
    for name, arguments in BASES.items():
        full = [a.replace("SCENES", str(scenes)) for a in arguments] + [*BRIEFLY, name]
        status, _, error = server.run(full, 60)
        if status != "0":
            sys.exit(f"fuzz: {' '.join(full)}: {status}: {error.decode()}")
        # Only what is used: a file of its own length holds less room for nothing.
        bases[name] = server.folder / ("small_" + name)
        with h5py.File(server.folder / name) as old, h5py.File(bases[name], "w") as new:
            for key in old:
                old.copy(key, new)
            for key, value in old.attrs.items():
                new.attrs[key] = value
            if name == "slide.h5":
                # As if it had been stopped halfway, so that it can be gone on with.
                new.attrs["status"] = "failed: interrupted at step 10"
                scene = new.attrs["scene"]
                assert "duration = 0.1\n" in scene
                new.attrs["scene"] = scene.replace("duration = 0.1\n", "duration = 0.15\n")
        bases["whole_" + name] = server.folder / name
    data = pathlib.Path(options.source) / "data"
    files = [*data.glob("*.toml"), *scenes.glob("*.toml"), *5 * list((data / "specimens").glob("*.toml"))]
    texts = [f.read_text() for f in sorted(files) if f.name != "presets.toml"]
    return bases, texts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server", help="fork_server, built with the sanitizers or without")
    parser.add_argument("--source", default=str(pathlib.Path(__file__).parents[2]))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after this time")
    parser.add_argument("--cases", type=int, default=CASES)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", default="out/fuzz", help="folder for inputs that found a fault")
    options = parser.parse_args()
    options.server = str(pathlib.Path(options.server).resolve())
    options.keep = str(pathlib.Path(options.keep).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        bases, texts = make_bases(options, folder)
        results = multiprocessing.Queue()
        workers = [multiprocessing.Process(target=work, args=(number, options, folder, bases, texts, results)) for number in range(options.jobs)]
        for worker in workers:
            worker.start()
        done = [results.get() for _ in workers]
        for worker in workers:
            worker.join()
    cases = {kind: sum(d[0][kind] for d in done) for kind in done[0][0]}
    seen = sum((d[1] for d in done), collections.Counter())
    faults = [f for d in done for f in d[3]]
    for name in sorted({name for name, _ in seen}):
        ends = ", ".join(f"{count} ended with {status}" for (of, status), count in sorted(seen.items()) if of == name)
        print(f"{name}: {ends}; the longest took {max(d[2].get(name, 0) for d in done):.1f} s")
    print(f"seed {options.seed}:", ", ".join(f"{count} {kind}" for kind, count in cases.items()), "cases,", end=" ")
    print(sum(seen.values()), "commands,", len(faults), "faults")
    return 1 if faults or any(worker.exitcode for worker in workers) else 0


if __name__ == "__main__":
    sys.exit(main())
