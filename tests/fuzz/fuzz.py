"""Gives the program hostile, damaged and extreme input, through every subcommand. See tests/fuzz.sh."""

import argparse
import multiprocessing
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

import mutations
import named_cases

LATE = 10  # s of CPU time; what takes longer counts as hung
NAMED_SHARE = 0.4  # of the time at most, for the named cases
SLOW = 10  # commands that draw or compare take part in one of so many cases
SHORT = [
    part
    for value in ("duration=0.1", "step=0.01", "frame_interval=0.02", "checkpoint_interval=0.04")
    for part in ("--set", "time." + value)
]
KINDS = ["log flip", "qp flip", "log change", "qp change", "toml", "csv", "scene"]
BASES = {
    "rest.h5": ["run", "table1", "--qp", "active-set", "--quiet", "--set", "model.bodies=8", *SHORT],
    "slide.h5": ["run", "SCENES/knot_into_head.toml", "--qp", "active-set", "--quiet", *SHORT],
    "box.qp.h5": ["record-qp", "SCENES/redundant.toml", "--qp", "active-set", "--quiet", *SHORT],
    "primal.qp.h5": ["record-qp", "SCENES/redundant.toml", "--primal", "--qp", "active-set", "--quiet", *SHORT],
}


def is_clean(text):
    return all(c in "\n\t" or (ord(c) >= 32 and not 127 <= ord(c) < 160) for c in text)


def fault(status, output):
    """What is wrong with how a command ended, or nothing."""
    text = output.decode("utf-8", "replace")
    if status == "late":
        return "took longer than 10 s"
    if status not in ("0", "1", "2", "3"):
        return "ended with " + status + " " + " ".join(line for line in text.split("\n") if "ERROR" in line)[:300]
    for word in ("internal error", "runtime error:", "Sanitizer", "Press Enter"):
        if word in text:
            return next(line for line in text.split("\n") if word in line)[:300]
    if not is_clean(text):
        return "printed control characters"
    if len(text) > 100000 or max(map(len, text.split("\n"))) > 5000:
        return "printed too much"
    if status == "2" and len(text.strip().split("\n")[-1].split("\n")) != 1:
        return "more than one line"
    return None


class Server:
    """The commands, run by the fork server in a folder of its own."""

    def __init__(self, program, folder):
        folder.mkdir()
        self.folder = folder
        environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
        environment["ASAN_OPTIONS"] = "detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=8000"
        environment["UBSAN_OPTIONS"] = "halt_on_error=1:print_stacktrace=1"
        self.process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder, env=environment, text=True
        )

    def run(self, arguments, seconds=LATE):
        self.process.stdin.write("\t".join([str(seconds), *arguments]) + "\n")
        self.process.stdin.flush()
        status = self.process.stdout.readline().strip()
        return status, (self.folder / "out.txt").read_bytes()


def commands_for(kind, file, slow, overrides=()):
    """Every subcommand that reads such a file; `slow` ones too where asked."""
    if kind.startswith("log"):
        yield ["info", file]
        yield ["check", file, "--csv", "check.csv", "--force"]
        yield ["playback", file, "--out", "playback.h5", "--force"]
        yield ["branch", file, "--out", "branch.h5", "--quiet", "--force"]
        if slow:
            yield ["info", file, "--json"]
            yield ["export", file, "--out", "tables", "--force"]
            yield ["view", file, "--out", "replay.html", "--force"]
            yield ["picture", file, "--out", "picture.png", "--force"]
            yield ["program", file, "--out", "program.csv", "--force", "--stations", "4", "--times", "3"]
        yield ["run", "--resume", file, "--quiet"]  # last, as it goes on in the file itself
    elif kind.startswith("qp"):
        yield ["qp", file, "--repeat", "1", "--backend", "active-set", "--csv", "qp.csv", "--force"]
        if slow:
            yield ["qp", file, "--repeat", "1"]
    else:
        cut = list(overrides) if kind == "scene" else SHORT + ["--set", "model.bodies=8"]
        yield ["run", file, "--qp", "active-set", "--quiet", "--out", "run.h5", "--force", *cut]
        yield ["record-qp", file, "--qp", "active-set", "--quiet", "--out", "qp.h5", "--force", *cut]
        yield ["mjcf", file, "--out", "mjcf", "--force", *cut]
        yield ["stress", file, "--cpu-limit", "3", *cut]
        if slow:
            yield ["run", file, "--qp", "ipopt", "--quiet", "--out", "run.h5", "--force", *cut]
            yield ["compare", file, "--out", "compare.h5", "--force", *cut]
            yield ["integrate", file, "--out", "integrate.h5", "--force", *cut]


class Worker:
    def __init__(self, number, options, folder, bases, texts):
        self.random = np.random.default_rng([options.seed, number])
        self.keep = pathlib.Path(options.keep)
        self.folder = folder / f"w{number}"
        self.server = Server(options.server, self.folder)
        self.bases = {name: path.read_bytes() for name, path in bases.items()}
        self.paths = bases
        self.blocks = {name: mutations.used_blocks(data) for name, data in self.bases.items()}
        self.texts = texts
        self.program = (pathlib.Path(options.source) / "data/programs/overhand.csv").read_text()
        self.cases = dict.fromkeys(["named", *KINDS], 0)
        self.commands = 0
        self.faults = []

    def base(self, kind):
        names = [n for n in self.bases if n.endswith(".qp.h5") == kind.startswith("qp")]
        return names[self.random.integers(len(names))]

    def make(self, kind):
        """A case of `kind` as a file; nothing where a change does not apply."""
        file = self.folder / ("case.h5" if kind not in ("toml", "csv") else "case.toml")
        if kind == "csv":
            (self.folder / "case.csv").write_bytes(mutations.mutated_csv(self.program, self.random))
            file.write_text('base = "living_overhand"\n[script]\nprogram = "case.csv"\n')
            return file.name
        if kind == "scene":
            return "table1"
        if kind == "toml":
            text = mutations.mutated_text(self.texts[self.random.integers(len(self.texts))], self.random)
            file.write_bytes(text.encode("utf-8", "surrogateescape"))
        elif kind.endswith("flip"):
            base = self.base(kind)
            file.write_bytes(mutations.flipped(self.bases[base], self.blocks[base], self.random))
        elif not named_cases.changed_log(
            self.paths[self.base(kind)], lambda log: mutations.structured(log, self.random), file
        ):
            return None
        return file.name

    def take(self, kind, name, file, slow, overrides=()):
        self.cases[kind if kind in self.cases else "named"] += 1
        for arguments in commands_for(kind, file, slow, overrides):
            if arguments[0] == "integrate" and kind in ("toml", "csv"):
                continue  # of whatever number of bodies, for minutes
            status, output = self.server.run(arguments)
            self.commands += 1
            found = fault(status, output)
            if (self.folder / "MUJOCO_LOG.TXT").exists():
                found = found or "wrote MUJOCO_LOG.TXT"
                (self.folder / "MUJOCO_LOG.TXT").unlink()
            if found:
                kept = file
                if (self.folder / file).exists():
                    kept = self.keep / f"{name}{pathlib.Path(file).suffix}"
                    self.keep.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(self.folder / file, kept)
                shown = " ".join(a if a != file else str(kept) for a in arguments)
                self.faults.append(f"{name}: {found}\n    hagfish {shown}")
                print(self.faults[-1], flush=True)

    def named(self, number, workers, seed, end):
        """This worker's share of them, in an order by the seed, until the time is over."""
        cases = list(named_cases.log_changes().items())
        np.random.default_rng(seed).shuffle(cases)
        for name, change in cases[number::workers]:
            for base in ("rest.h5", "slide.h5"):
                if time.monotonic() > end:
                    return
                file = self.folder / "case.h5"
                if named_cases.changed_log(self.paths[base], change, file):
                    self.take("log", f"{name}_{base[:-3]}", file.name, slow=name.startswith("mjcf"))

    def one(self, kind, count):
        file = self.make(kind)
        if file is None:
            return False
        overrides = mutations.extreme_overrides(self.random) if kind == "scene" else ()
        name = f"{kind.replace(' ', '_')}_{id(self) % 1000}_{count}"
        self.take(kind, name, file, self.random.integers(SLOW) == 0, overrides)
        return True


def work(number, options, folder, bases, texts, results):
    begin = time.monotonic()
    end = begin + 60 * options.minutes
    worker = Worker(number, options, folder, bases, texts)
    worker.named(number, options.jobs, options.seed, begin + NAMED_SHARE * (end - begin))
    wanted = {
        "log flip": 0.75 * options.flips, "qp flip": 0.25 * options.flips, "log change": options.changes / 3,
        "qp change": options.changes / 3, "toml": options.changes / 6, "csv": options.changes / 6, "scene": options.scenes,
    }  # fmt: skip
    wanted = {kind: int(np.ceil(count / options.jobs)) for kind, count in wanted.items()}
    tries = 0
    while time.monotonic() < end:
        # The kind that is furthest behind, so that a short run has some of each.
        left = {kind: 1 - worker.cases[kind] / count for kind, count in wanted.items() if worker.cases[kind] < count}
        if not left:
            break
        worker.one(max(left, key=left.get), tries)
        tries += 1
    results.put((worker.cases, worker.commands, worker.faults))


def make_bases(options, folder):
    server = Server(options.server, folder / "bases")
    scenes = pathlib.Path(options.source) / "experiments/stability"
    bases = {}
    for name, arguments in BASES.items():
        full = [a.replace("SCENES", str(scenes)) for a in arguments] + ["--out", name, "--force"]
        status, output = server.run(full, 60)
        if status != "0":
            sys.exit(f"fuzz: {' '.join(full)}: {status}: {output.decode()}")
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
    texts = [f.read_text() for f in [*data.glob("*.toml"), *scenes.glob("*.toml")] if f.name != "presets.toml"]
    return bases, texts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server", help="fork_server, built with the sanitizers or without")
    parser.add_argument("--source", default=str(pathlib.Path(__file__).parents[2]))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after this time")
    parser.add_argument("--flips", type=int, default=20000)
    parser.add_argument("--changes", type=int, default=1000)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", default="out/fuzz", help="folder for inputs that found a fault")
    options = parser.parse_args()
    options.server = str(pathlib.Path(options.server).resolve())
    options.keep = str(pathlib.Path(options.keep).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        bases, texts = make_bases(options, folder)
        results = multiprocessing.Queue()
        workers = [
            multiprocessing.Process(target=work, args=(n, options, folder, bases, texts, results))
            for n in range(options.jobs)
        ]
        for worker in workers:
            worker.start()
        done = [results.get() for _ in workers]
        for worker in workers:
            worker.join()
    cases = {kind: sum(d[0][kind] for d in done) for kind in done[0][0]}
    faults = [f for d in done for f in d[2]]
    print(f"seed {options.seed}:", ", ".join(f"{count} {kind}" for kind, count in cases.items()), "cases,", end=" ")
    print(sum(d[1] for d in done), "commands,", len(faults), "faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
