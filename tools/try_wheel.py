"""Build the package, install it into an empty environment, use every command there once.

Run by `make wheel` and by continuous integration. The package is built twice: what numba compiles
in the first is shipped in the second, which is used and left in build/dist. Raw recordings to
reduce are rendered by the workshop of this checkout; everything else comes out of the wheel.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from dentscope.core.compiled import (
    COMPILED_FOR,
    SHIPPED,
    cache_folder,
    name_by_numba,
    runs_compiled,
    source_digest,
    take,
)

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "tools" / "requirements" / f"py3{sys.version_info.minor}.txt"
UV = Path(sys.executable).parent / "uv"
PRESSES = ROOT / "docs" / "tutorials" / "data" / "press-6061" / "press-6061.txt"
DIST = ROOT / "build" / "dist"
EXTRAS = "video,mocap,surface,tables"


class Use(NamedTuple):
    """One use of a command in the empty environment.

    `command`: what follows `dentscope`, words separated by blanks; `says`: part of what it prints,
    on either stream; `code`: exit code.
    """

    command: str
    says: str
    code: int = 0

    def is_of(self, command: str) -> bool:
        """Whether this is a use of a command."""
        words = command.split()
        return self.command.split()[: len(words)] == words


FIRST = (
    Use("impact --new ball", "ball.toml"),
    Use("impact ball.toml --out first", "energy balance"),
)
"""The first impact: what it needs came compiled."""

SOLVER = (
    Use("version", "0."),
    Use("doctor", "not installed"),
    Use("examples --to examples", "case_steel.toml"),
    Use("case examples/case_steel.toml --out case", "result.h5"),
    Use("case --new mine.toml", "dentscope case mine.toml"),
    Use("keys case", "max_delta_over_R"),
    Use("laws list", "fitted"),
    Use("laws show ghaednia", "Ghaednia"),
    Use("laws compare examples/case_steel.toml --law fitted --law hertz --out laws", "use:"),
    Use("campaign designs", "full"),
    Use("campaign run --design smoke --out run --limit-minutes 0.02", "missing of 12", 3),
    Use("campaign status --design smoke --out run", "designed 12"),
    Use("campaign show {case} --out run", "Delta/R"),
    Use("campaign refine {case} --out run", "largest difference"),
    Use("campaign export --out run --to curves.csv", "cases -> curves.csv"),
    Use("campaign repair --out run", "whole in run"),
    Use("campaign publish --design smoke --out run --to parts", "cases are missing", 2),
    Use("campaign reproduction", "checkout", 2),
    Use("export law --out sources", "dentscope_contact.f90"),
    Use(
        "export dem examples/case_steel.toml --speed 1 --mass 0.01 --out dem",
        "linear-hysteretic",
    ),
    Use("fit --publish", "checkout", 2),
)
"""Laws, solver and sweep: uses in this order, with the package's own dependencies only."""

IMPACT = (
    Use("impact {data}/../examples/impact_rod.toml --out impact", "energy balance"),
    Use("impact", "no file", 2),
    Use("inverse {data}/../examples/inverse_scar.toml --out inverse", "1.384"),
    Use("inverse --new scar.toml", "dentscope inverse scar.toml"),
    Use("recordings list", "kharaz-2001-oblique"),
    Use("recordings check kharaz-2001-oblique", "12 trials"),
    Use("recordings audit thesis-chapter-5", "thesis-chapter-5"),
    Use("recordings new set", "fill in"),
    Use("recordings add {data}/recordings/kharaz-2001-oblique absent.csv", "absent.csv", 2),
    Use("recordings fetch absent", "absent", 2),
    Use("materials steel-1010-hot-rolled", "207"),
    Use("metal kharaz-2001-oblique --out metal", "elastic-plastic", 2),
    Use("diagnose kharaz-2001-oblique --quiet --out diagnosis", "verdict.json"),
    Use("diagnose absent", "leeb-steel-300hv", 2),
    Use("verify", "checkout", 2),
    Use("figures", "checkout", 2),
    Use("proof run", "checkout", 2),
    Use("challenge get sets", "checkout", 2),
    Use("challenge ask sets", "checkout", 2),
    Use("reduce table rebounds.csv --holds rebounds --value 1 --out reduced", "restitution"),
    Use("reduce video clip.mkv --frame-rate-hz 80000 --pixel-m 2e-4", "dentscope[video]", 2),
)
"""Impact and recordings, at the same time as the others."""

WITH_EXTRAS = (
    Use("reduce sound ball.wav --out reduced", "restitution"),
    Use("reduce video clip.mkv --frame-rate-hz 80000 --pixel-m 2e-4 --out reduced", "restitution"),
    Use("reduce press press.txt --out reduced", "permanent_depth_m"),
    Use("reduce tip tip.png --pixel-m 1e-5 --out reduced", "tip_radius_m"),
    Use("reduce scan crater.csv --unit um --step-m 9e-6 --out reduced", "permanent_depth_m"),
    Use(
        "reduce mocap {data}/recordings/recipes/cube-toss/toss-0.csv --shape body "
        "--body {data}/recordings/recipes/cube-toss/body.toml --select toss=0 --out reduced",
        "restitution",
    ),
)
"""Uses that need the optional parts."""


COMPILED = (
    ("impact --new ball", "impact ball.toml --out out", "diagnose kharaz-2001-oblique --out set"),
    ("case --new pair.toml", "laws compare pair.toml --out laws", "case pair.toml --out pair"),
)
"""What compiles the code that is shipped, in two lanes."""


def main() -> int:
    """Build, install, use; return the exit code."""
    with tempfile.TemporaryDirectory(prefix="dentscope-wheel-") as name:
        folder = Path(name)
        shutil.rmtree(DIST, ignore_errors=True)
        build(ROOT)
        environment = folder / "environment"
        run(UV, "venv", "-q", "-p", sys.executable, environment)
        (archive,), (wheel,) = DIST.glob("*.tar.gz"), DIST.glob("*.whl")
        install(environment, str(wheel))
        build(with_compiled_code(environment, archive, folder), "--wheel")
        install(environment, str(wheel))
        work = folder / "work"
        work.mkdir()
        write_recordings(work)
        uses = FIRST + SOLVER + IMPACT + WITH_EXTRAS
        missed = [c for c in commands(environment) if not any(u.is_of(c) for u in uses)]
        for command in missed:
            say(f"no use of `dentscope {command}` is tried")
        wrong = failures(environment, work, FIRST)
        with ThreadPoolExecutor(2) as lanes:
            both = lanes.map(lambda lane: failures(environment, work, lane), (SOLVER, IMPACT))
            wrong += sum(both)
        install(environment, f"{wheel}[{EXTRAS}]")
        wrong += failures(environment, work, WITH_EXTRAS)
    say(f"{len(uses) - wrong} of {len(uses)} uses as they should be")
    return 1 if wrong or missed else 0


def with_compiled_code(environment: Path, archive: Path, folder: Path) -> Path:
    """Unpack the source archive with what a package of it compiles here; return where."""
    place, cache = folder / "compiled", folder / "numba"
    place.mkdir()
    begun = time.monotonic()

    def compile_in(lane: Sequence[str]) -> None:
        for command in lane if runs_compiled() else ():
            subprocess.run(
                [environment / "bin/dentscope", *command.split()], cwd=place, capture_output=True,
                env=alone() | COMPILED_FOR | {"NUMBA_CACHE_DIR": str(cache)}, check=False,
            )  # fmt: skip

    with ThreadPoolExecutor(2) as lanes:
        list(lanes.map(compile_in, COMPILED))
    shutil.unpack_archive(archive, folder / "source", filter="data")
    (whole,) = (folder / "source").iterdir()
    package = package_in(environment)
    into = whole / SHIPPED / source_digest(package)
    for part in (p for p in package.rglob("*") if (cache / name_by_numba(p)).is_dir()):
        shutil.copytree(cache / name_by_numba(part), into / part.relative_to(package))
    # of this checkout too, which has the workshop beside it
    take(into, ROOT, cache_folder(f"compiled-{source_digest(ROOT)}"))
    say(f"{len(list(into.rglob('*.nbc')))} functions compiled in {time.monotonic() - begun:.0f} s")
    return whole


def package_in(environment: Path) -> Path:
    """Return the folder of the installed package."""
    return next(environment.glob("lib/python*/site-packages/dentscope"))


def say(line: str) -> None:
    """Print a line of the report."""
    print(f"wheel: {line}", flush=True)


def build(source: Path, *what: str) -> None:
    """Build source archive and wheel in isolation, the build tool pinned by hash."""
    pinned = ("--build-constraint", LOCK, "--require-hashes")
    run(UV, "build", "-q", *pinned, "-o", DIST, *what, source)
    for path in sorted(DIST.glob("dentscope-*")):
        say(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")
    (wheel,) = DIST.glob("*.whl")
    with zipfile.ZipFile(wheel) as file:
        names = file.namelist()
    say(f"{len(names)} files in the wheel, {sum(n.endswith('.py') for n in names)} of them Python")


def install(environment: Path, what: str) -> None:
    """Install the wheel with the dependencies pinned that it asks for."""
    pins = environment / "pins.txt"
    if not pins.exists():
        # constraints of a package that is asked for by file cannot require hashes
        lines = [line.removesuffix(" \\") for line in LOCK.read_text().splitlines()]
        pins.write_text("\n".join(line for line in lines if not line.lstrip().startswith("--hash")))
    begun = time.monotonic()
    anew = ("--reinstall-package", "dentscope")
    run(UV, "pip", "install", "-q", *anew, "--python", environment / "bin/python", "-c", pins, what)
    size = sum(p.stat().st_size for p in environment.rglob("*") if not p.is_symlink())
    say(f"installed in {time.monotonic() - begun:.1f} s; the environment holds {size / 1e9:.2f} GB")


def commands(environment: Path) -> set[str]:
    """Names of all commands that the installed package has, hidden ones too."""
    program = (
        "import typer\nfrom dentscope.cli.app import app\n"
        "def walk(c, path):\n"
        "    names = c.list_commands(None) if hasattr(c, 'list_commands') else []\n"
        "    for n in names: walk(c.get_command(None, n), [*path, n])\n"
        "    if not names: print(' '.join(path))\n"
        "walk(typer.main.get_command(app), [])\n"
    )
    answer = run(environment / "bin/python", "-c", program, cwd=environment)
    return set(answer.split("\n")) - {""}


def write_recordings(folder: Path) -> None:
    """Render raw recordings to reduce: bounces heard and written down, a clip, a tip, a crater."""
    # now that what they load is compiled
    from dentscope.studies.synthetic.clips import ClipTruth, render, write_video
    from dentscope.studies.synthetic.scans import ScanTruth, true_surface
    from dentscope.studies.synthetic.sounds import SoundTruth, record, write_wav
    from dentscope.studies.synthetic.tip import TipTruth, photograph
    from matplotlib.image import imsave

    write_wav(record(SoundTruth()), folder / "ball.wav")
    shutil.copyfile(PRESSES, folder / "press.txt")
    rows = "\n".join(f"{h},{0.49 * h}" for h in (0.2, 0.4, 0.8))
    (folder / "rebounds.csv").write_text(f"drop_m,up_m\n{rows}\n")
    write_video(render(ClipTruth()), folder / "clip.mkv")
    imsave(folder / "tip.png", photograph(TipTruth()), cmap="gray", vmin=0, vmax=255)
    surface = true_surface(ScanTruth()) * 1e6
    text = "\n".join(",".join(f"{z:.4f}" for z in row) for row in surface)
    (folder / "crater.csv").write_text(text + "\n")


def failures(environment: Path, folder: Path, uses: Sequence[Use]) -> int:
    """Run uses in their order; return how many went wrong."""
    return sum(not try_one(environment, folder, use) for use in uses)


def try_one(environment: Path, folder: Path, use: Use) -> bool:
    """Run one use and say whether it does what it should."""
    data = package_in(environment) / "data"
    words = use.command.format(data=data, case=first_case(environment, folder, use)).split()
    begun = time.monotonic()
    answer = subprocess.run(
        [environment / "bin/dentscope", *words],
        cwd=folder, env=alone() | {"XDG_CACHE_HOME": str(folder / "cache")},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    told = answer.stdout + answer.stderr
    fine = answer.returncode == use.code and use.says in told and "Traceback" not in told
    fine &= use.code != 2 or len(answer.stderr.splitlines()) == 1
    fine &= "first use" not in told or not runs_compiled()  # compiled code came with the wheel
    mark = "ok" if fine else f"WRONG (exit {answer.returncode})"
    say(f"{time.monotonic() - begun:6.1f} s  {mark:8} dentscope {use.command}")
    if not fine:
        say(f"asked for exit {use.code} and {use.says!r}; it printed\n{told}")
    return fine


def first_case(environment: Path, folder: Path, use: Use) -> str:
    """Return the beginning of the id of a case that the sweep solved, where a use asks for it."""
    if "{case}" not in use.command:
        return ""
    program = (
        "from pathlib import Path\nfrom dentscope.campaigns import Store\n"
        "print(Store(Path('run')).summaries()[0].id)"
    )
    return run(environment / "bin/python", "-c", program, cwd=folder)[:12]


def alone() -> dict[str, str]:
    """Return the variables of this process without those that lead back to the checkout."""
    apart = ("PYTHONPATH", "VIRTUAL_ENV", "NUMBA_CACHE_DIR")
    return {k: v for k, v in os.environ.items() if k not in apart}


def run(*words: object, cwd: Path | None = None) -> str:
    """Run a step that must succeed; return what it printed."""
    answer = subprocess.run(
        [str(word) for word in words],
        cwd=cwd, env=alone(), capture_output=True, text=True, check=False,
    )  # fmt: skip
    if answer.returncode:
        sys.exit(f"wheel: {shutil.which(str(words[0]))} failed:\n{answer.stderr}")
    return answer.stdout


if __name__ == "__main__":
    sys.exit(main())
