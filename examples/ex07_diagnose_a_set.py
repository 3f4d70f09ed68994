"""What does the simulation of a recording lack? A published set, diagnosed."""

# %% A ball on a thick plate at twelve angles (Kharaz, Gorham and Salman 2001), shipped.
import dentscope as ds

SET = "kharaz-2001-oblique"
found = ds.diagnose(SET)
print(found.finding)

# %% Where the simulation misses, how sure the finding is, and what to measure next.
for sentence in found.story.misses:
    print("-", sentence)
for bar in found.story.parts:
    print(f"{bar.told:>14}  {bar.name}")
print(found.story.next_step)

# %% Measured beside simulated, as a table; `found.report("report.html")` writes the page.
table = found.frame()
print(table[["angle_deg", "observable", "measured", "as_stated", "with_verdict"]].head())
