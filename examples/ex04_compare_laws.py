"""Which contact law for my pair? All of them side by side, and which to use."""

# %% A hard ball on soft steel, pressed in by a hundredth of its radius.
import dentscope as ds

hard = ds.Material(E=210e9, nu=0.3, Sy=2000e6)
soft = ds.Material(E=200e9, nu=0.3, Sy=300e6)
pair = ds.Pair(sphere=hard, flat=soft, R=10e-3)
found = ds.compare_laws(pair, max_delta_over_R=0.01)
print(found)

# %% How far each is from finite elements in force, dent and restitution.
for name, off in found.departures.items():
    print(f"{name}: {off.told}")

# %% The same as numbers: force, and what stays of the depth.
best = found.best
force = {row.law: row.force_N for row in found.last_rows()}
left = {row.law: row.residual_sphere_m + row.residual_flat_m for row in found.last_rows()}
print(f"{best[0]}: {force[best[0]]:.0f} N, {left[best[0]] * 1e6:.1f} um stay")

# %% Over the depth: laws to use in colour, the others grey.
figure = found.plot()
