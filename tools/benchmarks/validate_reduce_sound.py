"""Reduce rendered recordings of bouncing balls and compare with what they were made of.

    python tools/benchmarks/validate_reduce_sound.py [COUNT]

Each record has a ball whose restitution falls with speed, drag, ringing at each contact, an echo,
noise at a drawn level, up to two knocks that belong to nothing, and clipping in some.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.studies.synthetic.sounds import bounces, random_bounces, record, write_wav
from honesty import judge


def main(count):
    kind = load_kind("sound")
    rows, failed, found_part = [], 0, []
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "a.wav"
        for seed in range(count):
            truth = random_bounces(seed)
            write_wav(record(truth), path)
            given = {
                "mass_kg": truth.mass,
                "diameter_m": truth.diameter,
                "contact_time_s": truth.contact_time,
            }
            try:
                reduced = kind.run(path, given, source="validation")
            except InputError as error:
                failed += 1
                print(seed, error)
                continue
            true = np.array(bounces(truth))
            matched = 0
            for trial in reduced.trials:
                v, e = trial.observables["impact_speed_m_s"], trial.observables["restitution"]
                near = int(np.argmin(np.abs(true[:, 1] - v.value)))
                matched += abs(true[near, 1] / v.value - 1.0) < 0.03
                rows.append((v.value, true[near, 1], v.std, e.value, true[near, 2], e.std))
            found_part.append(matched / max(len(true) - 2, 1))
    a = np.array(rows)
    print(f"{count} records, {failed} without a result, {len(a)} bounces")
    wrong = np.abs(a[:, 0] / a[:, 1] - 1.0) > 0.03
    print(f"bounces that match none of the record: {wrong.sum()}")
    print(f"inner bounces found, mean over the records: {100 * np.mean(found_part):.1f} %")
    for name, (x, true, std) in {"speed": a[~wrong, :3].T, "restitution": a[~wrong, 3:].T}.items():
        judge(f"{name}, relative", x / true - 1.0, std / true)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
