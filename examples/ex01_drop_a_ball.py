"""Drop a steel ball on steel: restitution, crater, contact time, by several contact laws."""

# %% One drop from half a metre. Every key of `[impact]` can be changed by name.
import dentscope as ds
import numpy as np

blow = ds.impact("ball", law=["fitted", "hertz", "ghaednia"], drop_height_m=0.5)
print(blow)

# %% Force over depth, and what moves against time.
picture = blow.plot()

# %% Restitution over the height: the higher the drop, the more stays in the crater.
heights = np.geomspace(0.01, 1.0, 7)
restitution = [ds.impact("ball", law="fitted", drop_height_m=float(h))["fitted"].restitution
               for h in heights]  # fmt: skip
for h, e in zip(heights, restitution, strict=True):
    print(f"{h:6.3f} m: e = {e:.3f}")
