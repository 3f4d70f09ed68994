"""How far a reduced number is off, and how honest its stated error: one line for each number."""

import numpy as np


def judge(name, error, std):
    """Print bias, spread and honesty of the records in which a number was found."""
    error, std = np.asarray(error), np.asarray(std)
    found = np.isfinite(error)
    if not found.any():
        print(f"{name}: none found")
        return
    error, std = error[found], std[found]
    off, pull = np.abs(error), error / std
    spread = 1.4826 * np.median(np.abs(pull - np.median(pull)))
    print(
        f"{name}: {found.sum()} of {found.size}, bias {error.mean():+.3g} ± "
        f"{error.std() / np.sqrt(error.size):.2g}, rms {np.sqrt(np.mean(error**2)):.3g}, median "
        f"{np.median(off):.3g}, 95 % below {np.quantile(off, 0.95):.3g}, worst {off.max():.3g}, "
        f"stated {np.median(std):.3g}; pulls: median {np.median(pull):+.2f}, spread "
        f"{spread:.2f}, std {pull.std():.2f}, within 2: "
        f"{np.mean(np.abs(pull) < 2.0):.1%}, largest {np.abs(pull).max():.1f}, beyond 6: "
        f"{np.sum(np.abs(pull) > 6.0)}"
    )
