"""What a file says of how a metal flows: tables whose `law` says which numbers they need."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

from pydantic import Field

from ..errors import InputError
from .toml_input import InputTable

if TYPE_CHECKING:  # numpy comes with it, and the command line starts without
    from ..flow import FlowCurve, Heating, Rate

_HARDENING = {
    "swift": ("K_Pa", "n"),
    "ludwik": ("K_Pa", "n"),
    "voce": ("Q_Pa", "b"),
    "johnson-cook": ("B_Pa", "n"),
}
_RATE = {
    "cowper-symonds": ("D_1_s", "q"),
    "johnson-cook": ("rate_0_1_s", "C"),
    "overstress": ("rate_0_1_s", "m", "stress_Pa"),
}


class _LawTable(InputTable):
    """A table whose `law` says which of its numbers are needed."""

    def numbers(
        self, needed: Mapping[str, tuple[str, ...]], *, key: str, source: str
    ) -> list[float]:
        """Return the law's numbers in its order; refuse a missing one, and one of another law."""
        law = self.__dict__["law"]
        given = {k: v for k, v in self.__dict__.items() if k != "law" and v is not None}
        for name in needed[law]:
            if name not in given:
                raise InputError(
                    "missing", source=source, key=f"{key}.{name}", allowed=f"a number for {law}"
                )
        for name in given.keys() - set(needed[law]):
            raise InputError(
                f"{given[name]:g}", source=source, key=f"{key}.{name}",
                allowed=f"{', '.join(needed[law])} with law = {law!r}",
            )  # fmt: skip
        return [given[name] for name in needed[law]]


class HardeningTable(_LawTable):
    """`[BODY.hardening]`: flow stress over plastic strain p, from Sy_Pa on."""

    law: Literal["swift", "ludwik", "voce", "johnson-cook"]
    """K (e0 + p)^n, Sy + K p^n, Sy + Q (1 - exp(-b p)), Sy + B p^n."""
    K_Pa: float | None = Field(default=None, gt=0.0)
    """Of Swift's or Ludwik's law."""
    B_Pa: float | None = Field(default=None, gt=0.0)
    """Of Johnson and Cook's law."""
    Q_Pa: float | None = Field(default=None, gt=0.0)
    """Of Voce's law."""
    n: float | None = Field(default=None, gt=0.0, le=1.0)
    """Exponent."""
    b: float | None = Field(default=None, gt=0.0)
    """Of Voce's law."""

    def curve(self, Sy: float, *, key: str, source: str) -> FlowCurve:
        """Return the law as a flow curve that begins at `Sy` [Pa]."""
        from ..flow import ludwik, swift, voce

        first, second = self.numbers(_HARDENING, key=key, source=source)
        if self.law == "voce":
            return voce(Sy=Sy, Q=first, b=second)
        if self.law == "swift":
            if first <= Sy:
                raise InputError(
                    f"{first:g}", source=source, key=f"{key}.K_Pa", allowed=f"above Sy_Pa = {Sy:g}"
                )
            return swift(Sy=Sy, K=first, n=second)
        return ludwik(Sy=Sy, K=first, n=second)


class RateTable(_LawTable):
    """`[BODY.rate]`: flow stress at a rate of plastic strain."""

    law: Literal["cowper-symonds", "johnson-cook", "overstress"]
    """1 + (rate/D)^(1/q), 1 + C ln(rate/rate_0), or an added stress."""
    D_1_s: float | None = Field(default=None, gt=0.0)
    """Of Cowper and Symonds' law."""
    q: float | None = Field(default=None, ge=1.0)
    """Of Cowper and Symonds' law."""
    rate_0_1_s: float | None = Field(default=None, gt=0.0)
    """Rate at which the strength was measured."""
    C: float | None = Field(default=None, ge=0.0)
    """Of Johnson and Cook's law."""
    m: float | None = Field(default=None, gt=0.0, le=1.0)
    """Exponent of the overstress."""
    stress_Pa: float | None = Field(default=None, ge=0.0)
    """Overstress at the reference rate."""

    def rate(self, *, key: str, source: str) -> Rate:
        """Return the law."""
        from ..flow import Rate

        return Rate(self.law, *self.numbers(_RATE, key=key, source=source))


class HeatingTable(InputTable):
    """`[BODY.heating]`: adiabatic heating and softening."""

    capacity_J_m3K: float = Field(gt=0.0)
    """Heat capacity of a volume."""
    melting_rise_K: float = Field(gt=0.0)
    """Melting temperature above that of the test."""
    exponent: float = Field(default=1.0, gt=0.0)
    """Of the softening."""
    fraction: float = Field(default=0.9, ge=0.0, le=1.0)
    """Part of the plastic work that becomes heat."""

    def heating(self) -> Heating:
        """Return the law."""
        from ..flow import Heating

        return Heating(self.fraction, self.capacity_J_m3K, self.melting_rise_K, self.exponent)
