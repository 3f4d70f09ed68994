"""A made-up recording set for the tests: a striker on a steel flat, by columns of trials.csv."""

from dentscope.recordings import read

STEEL = "E_Pa = 2e11\nnu = 0.3\n"
BALL = f'shape = "sphere"\ntip_radius_m = 5e-3\nmass_kg = 4e-3\n{STEEL}'


def made_set(
    folder, striker=BALL, *, head="", target="Sy_Pa = 3.5e8\n", noise="", more="", trace=None,
    **columns,
):  # fmt: skip
    n = len(next(iter(columns.values())))
    columns = {"trial": [f"t{i}" for i in range(n)], "striker": ["body"] * n, **columns}
    setup = f'format = "recording-set/1"\nname = "a"\n{head}[target]\n{STEEL}{target}'
    setup += f"[strikers.body]\n{striker}[noise]\n{noise}{more}"
    (folder / "set.toml").write_text(setup, encoding="utf-8")
    (folder / "trials.csv").write_text(_csv(columns), encoding="utf-8")
    if trace is not None:
        (folder / "traces").mkdir(exist_ok=True)
        (folder / "traces" / "t0.csv").write_text(_csv(trace), encoding="utf-8")
    return read(folder)


def _csv(columns):
    rows = (columns, *zip(*columns.values(), strict=True))
    return "".join(",".join(map(str, row)) + "\n" for row in rows)
