"""A named tuple of arrays that kernels hand on as one pointer.

numba passes a tuple field for field: the two bundles of the walk came to 230 machine words a call,
which cost more to compile and to run than most of the kernels that took them.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, intrinsic, lower_getattr_generic, models, register_model


class Bundle(types.Type):  # type: ignore[misc]
    """Type of the place of a named tuple; fields are read as the tuple's own, never written.

    `held`: numba's type of the named tuple.
    """

    def __init__(self, held: Any) -> None:
        self.held = held
        super().__init__(name=f"Bundle({held})")


@register_model(Bundle)
class _BundleModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Bundle) -> None:
        place = manager.lookup(kind.held).get_data_type().as_pointer()
        super().__init__(manager, kind, place)


@infer_getattr
class _BundleFields(AttributeTemplate):  # type: ignore[misc]
    key = Bundle

    def generic_resolve(self, bundle: Bundle, name: str) -> Any:
        fields = bundle.held.fields
        return bundle.held.types[fields.index(name)] if name in fields else None


def _read_field(context: Any, builder: Any, kind: Bundle, place: Any, name: str) -> Any:
    index = kind.held.fields.index(name)
    field = context.data_model_manager[kind.held.types[index]]
    return field.load_from_data_pointer(builder, cgutils.gep_inbounds(builder, place, 0, index))


lower_getattr_generic(Bundle)(_read_field)


def _bundled(_typing: Any, held: Any) -> Any:
    """Return the place of a copy of a named tuple on the stack of the kernel that asks.

    It lives until that kernel returns, and owns none of the arrays: they have to outlive its use.
    """

    def code(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        model = context.data_model_manager[held]
        place = cgutils.alloca_once(builder, model.get_data_type())
        builder.store(model.as_data(builder, arguments[0]), place)
        return place

    return Bundle(held)(held), code


bundled = intrinsic(_bundled)
