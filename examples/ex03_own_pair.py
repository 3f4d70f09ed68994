"""One's own pair by finite elements, beside the fitted law: half a minute at the coarse level."""

# %% The file that `dentscope case --new` writes, here pressed only a little.
from pathlib import Path
from tempfile import TemporaryDirectory

import dentscope as ds
from dentscope.start.case_file import read_pair

TEXT = """
radius_m = 0.005
sphere = { E_Pa = 2.1e11, nu = 0.3, Sy_Pa = 2.0e9 }
flat = { E_Pa = 2.0e11, nu = 0.3, Sy_Pa = 3.0e8 }
load = { max_delta_over_R = 0.001, unload_from = [0.001] }
accuracy = { level = "smoke" }
"""

# %% Solve it; the uncertainty is what the level of accuracy was found to be off.
with TemporaryDirectory() as folder:
    file = Path(folder) / "case.toml"
    file.write_text(TEXT)
    _, pair = read_pair(file)
    solved = ds.case(file)
rows = solved.rows()

# %% Beside the law that was fitted to such solves.
law = ds.LAWS["fitted"]
for row in rows[9::10]:
    depth = row["delta_over_R"] * pair.R
    print(
        f"delta/R {row['delta_over_R']:.2e}: {row['force_N']:8.3f} +- "
        f"{row['force_N_uncertainty']:.3f} N, law {float(law.loading(pair, depth)):8.3f} N"
    )
left = solved.solution.unloadings[0]
print(f"left in the flat: {left.residual_flat * 1e6:.3f} um")
