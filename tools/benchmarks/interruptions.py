"""Ctrl-C and SIGTERM at random moments of every long command: how soon it stops, what it leaves.

`python tools/benchmarks/interruptions.py --stops 60` starts the commands below in turn, each over
and
over in a folder of its own, so that it goes on from what the interruptions before have left. Ctrl-C
goes to all processes of the command, as from a terminal, SIGTERM to the first alone. Looked at: the
processor seconds and the time until it ended, whether it was inside a compiled call meanwhile, exit
code 130 or 143, one line, no process left. In the end each command runs on undisturbed.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

STOPS_S = 2.0
PATIENCE_S = 120.0
RIG = """
[target]
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = { value = 3.0e8, std = 3e7 }
[strikers.ball]
shape = "sphere"
tip_radius_m = { value = 0.01, std = 1e-5 }
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 7.5e8
density_kg_m3 = 7800
[friction]
coefficient = 0.1
[impact]
impact_speed_m_s = 3.0
"""
SWEEP = """laws = ["fitted", "stronge", "thornton"]
[sweep]
impact_speed_m_s = { from = 0.01, to = 50.0, count = 1000, spacing = "log" }
angle_deg = { from = 5.0, to = 90.0, count = 60 }
"""
COMMANDS = {
    "impact sweep": (6, "impact sweep.toml --out out"),
    "impact": (4, "impact ball.toml --out out"),
    "laws compare": (4, "laws compare case.toml --out out"),
    "inverse": (4, "inverse --out out"),
    "case": (6, "case case.toml --out out"),
    "campaign run": (8, "campaign run --design small --workers 2 --out out"),
    "diagnose": (6, "diagnose kharaz-2001-oblique --out out"),
    "diagnose --confirm": (6, "diagnose thesis-chapter-5 --confirm --out out"),
    "fit": (4, "fit --out out"),
    "verify": (4, "verify --quick --folder out --report out/report.md"),
    "proof run": (6, "proof run --list small --workers 2 --out out"),
    "metal": (3, "metal thesis-chapter-3 --out out"),
    "reduce video": (3, "reduce video clip --frame-rate-hz 20000 --pixel-m 2e-4 --shape sphere"),
}  # fmt: skip
"""How many of 64 stops, and the command; the folder `out` stays from one stop to the next."""
FOR_EVER = ("campaign run", "proof run", "fit", "verify", "diagnose --confirm", "case")
"""What would take long to its end: that it goes on is seen by its next interruption."""


def inputs(folder):
    """Write what the commands read."""
    import numpy as np
    from dentscope.core.inputs.templates import CASE
    from matplotlib.image import imsave

    (folder / "ball.toml").write_text(RIG)
    (folder / "sweep.toml").write_text(RIG + SWEEP)
    (folder / "case.toml").write_text(CASE)
    (folder / "clip").mkdir()
    y, x = np.mgrid[:160, :96] + 0.5
    for k in range(300):
        middle = 130.0 - abs(k - 150.3) * 0.7
        grey = np.clip(40.0 + 160.0 * np.clip(20.5 - np.hypot(x - 48.0, y - middle), 0, 1), 0, 255)
        imsave(folder / "clip" / f"{k:03d}.png", np.dstack([grey.astype(np.uint8)] * 3))


def processes(session):
    """Numbers of the processes of a session, the dead aside."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            fields = status_of(int(entry.name))
            if fields and int(fields[3]) == session and fields[0] != "Z":
                found.append(int(entry.name))
    return found


def status_of(pid):
    try:
        return (Path("/proc") / str(pid) / "stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None


def listens(pid):
    """Whether a process has a handler of SIGTERM: before that it is Python that starts."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return False
    (caught,) = (line.split()[1] for line in lines if line.startswith("SigCgt"))
    return bool(int(caught, 16) >> (signal.SIGTERM - 1) & 1)


def begun(command, folder):
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "dentscope", *command.split()], cwd=folder,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip


def cpu_s(fields):
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def ended(process, within_s=PATIENCE_S):
    """Wait for the end of a process; return its output, or None."""
    try:
        return process.communicate(timeout=within_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return None


def stopped(command, folder, number, after_s):
    """Interrupt a command `after_s` processor seconds after its start; return what is wrong.

    Returns
    -------
    faults, seconds
        Words; until it ended, by the clock and of the command's processor.
    """
    process = begun(command, folder)
    while process.poll() is None:
        fields = status_of(process.pid)
        if listens(process.pid) and fields and cpu_s(fields) > after_s:
            break
        time.sleep(0.01)
    before = status_of(process.pid)
    start, used = time.monotonic(), cpu_s(before) if before else 0.0
    if process.poll() is not None:
        process.communicate()
        return None, 0.0, 0.0
    if number == signal.SIGINT:
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    while (now := status_of(process.pid)) and now[0] != "Z":
        used_now = cpu_s(now)
        if time.monotonic() - start > PATIENCE_S:
            break
        time.sleep(0.005)
        used_last = used_now
    took, cpu = time.monotonic() - start, max(locals().get("used_last", used) - used, 0.0)
    told = ended(process)
    faults = []
    if told is None:
        return ["did not end"], took, cpu
    if process.returncode == 0:
        return None, took, cpu  # it had come to its end
    if process.returncode != 128 + number:
        faults.append(f"exit code {process.returncode}")
    said = [line for line in (told[0] + told[1]).splitlines() if "stopped" in line]
    if "Traceback" in told[1] or len(said) != 1:
        faults.append(f"said {told[1][-600:]!r}")
    end = time.monotonic() + 10.0
    while processes(process.pid) and time.monotonic() < end:
        time.sleep(0.02)
    if left := processes(process.pid):
        faults.append(f"{len(left)} processes left")
        for pid in left:
            os.kill(pid, signal.SIGKILL)
    return faults, took, cpu


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--stops", type=int, default=64)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="name of one command")
    parser.add_argument("--longest-s", type=float, default=20.0, help="processor seconds before")
    chosen = parser.parse_args()
    draw, counts, times = random.Random(chosen.seed), Counter(), []
    with tempfile.TemporaryDirectory() as place:
        base = Path(place)
        for name, (share, command) in COMMANDS.items():
            if chosen.only and name != chosen.only:
                continue
            folder = base / name.replace(" ", "-")
            folder.mkdir()
            inputs(folder)
            for k in range(max(1, round(share * chosen.stops / 64))):
                number = (signal.SIGINT, signal.SIGTERM)[k % 2]
                longest = chosen.longest_s
                while True:
                    after = 0.3 + draw.random() * longest
                    faults, took, cpu = stopped(command, folder, number, after)
                    if faults is not None:
                        break
                    longest *= 0.6  # it was done before: sooner
                counts["stops"] += 1
                counts["wrong"] += bool(faults)
                counts["late"] += cpu > STOPS_S
                times.append((took, cpu))
                say(f"{name}: {number.name} after {after:.2f} s, ended in {took:.2f} s, of the "
                    f"processor {cpu:.2f}{'; ' + '; '.join(faults) if faults else ''}")  # fmt: skip
            if name not in FOR_EVER:
                process = begun(command, folder)
                told = ended(process, 1200.0)
                counts["gone on"] += bool(told) and process.returncode == 0
                say(f"{name}: undisturbed, exit code {process.returncode}")
    took, cpu = zip(*times, strict=True)
    say(f"{dict(counts)}; at most {max(took):.2f} s, of the processor {max(cpu):.2f} s")


def say(line):
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
