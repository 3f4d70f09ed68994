"""Which contact law for my pair? All of them side by side, and which to use."""

# %% A hard ball on soft steel, pressed in by a hundredth of its radius.
import warnings

import dentscope as ds
from dentscope.models import DomainWarning
from dentscope.models.choose import demand, objection, recommended

hard = ds.Material(E=210e9, nu=0.3, Sy=2000e6)
soft = ds.Material(E=200e9, nu=0.3, Sy=300e6)
pair = ds.Pair(sphere=hard, flat=soft, R=10e-3)
depth = 0.01 * pair.R

# %% What the pair asks of a law.
need = demand(pair, depth)
best = recommended(ds.LAWS, need)
print(f"{need.w:.0f} times the depth of first yield, {need.regime}: use {', '.join(best)}")

# %% Force and what stays of the depth, by every law.
force, left = {}, {}
with warnings.catch_warnings():
    warnings.simplefilter("ignore", DomainWarning)  # the last column says what is out of range
    for name, law in ds.LAWS.items():
        force[name] = float(law.loading(pair, depth))
        left[name] = float(sum(law.residual(pair, depth)))
        against = objection(law, need) or "may be used"
        print(f"{name:20} {force[name]:9.0f} N {left[name] * 1e6:7.1f} um  {against}")
