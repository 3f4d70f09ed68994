"""Arrays that a kernel uses without counting its references to them.

A compiled function counts, with locked instructions, every slice that it takes and every array
that it hands on; in loops over small slices that is a third of all its time. Whoever calls a
kernel holds its arrays meanwhile, so that nothing has to be counted.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.core.base import BaseContext
from numba.extending import intrinsic
from numba.np.arrayobj import make_array


def _unowned(typing_context: Any, value: Any) -> Any:
    def code(context: BaseContext, builder: Any, signature: Any, arguments: Any) -> Any:
        return _without_owner(context, builder, signature.args[0], arguments[0])

    return value(value), code


def _without_owner(context: BaseContext, builder: Any, kind: types.Type, value: Any) -> Any:
    if isinstance(kind, types.Array):
        array = make_array(kind)(context, builder, value)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        array.parent = cgutils.get_null_value(array.parent.type)
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):
        for place, inner in enumerate(kind):
            part = builder.extract_value(value, place)
            value = builder.insert_value(
                value, _without_owner(context, builder, inner, part), place
            )
    return value


unowned = intrinsic(_unowned)
"""The same array, or tuple of arrays and numbers, without a count of references; for kernels.

Only for what the kernel's caller holds until it returns: an array of the kernel's own would be
freed once its last counted reference is gone.
"""
