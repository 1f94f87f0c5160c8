"""From typed Python to LLVM code, for kernels: less code than numba makes, which is most of compiling.

Numba keeps a variable that two blocks use in memory, and makes thirty instructions of an item of an array
and two hundred of a slice. Here a variable that is assigned once stays a value, and items and slices are a
few instructions. All else is numba's.
"""

from __future__ import annotations

import operator
import sys
from functools import reduce

from llvmlite.ir import Constant, Value
from numba.core import cgutils, ir, types
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import NativeLowering
from numba.np.arrayobj import load_item, store_item

_INTP = cgutils.intp_t
_ITEM = 8  # bytes of a number
_DATA, _SHAPE, _STRIDES = 4, 5, 6  # where numba has these in an array


class _Lower(Lower):
    """What makes the code of one kernel."""

    def init(self) -> None:
        super().init()
        self._values: dict[str, object] = {}
        # where references are counted, numba must see where each ends
        self._lasting = set() if self.context.enable_nrt else _assigned_once(self.func_ir.blocks)
        self._singly_assigned_vars -= self._lasting

    def _find_singly_assigned_variable(self) -> None:
        self._singly_assigned_vars, self._blk_local_varmap = set(), {}
        if self.context.enable_nrt:
            super()._find_singly_assigned_variable()

    def _alloca_var(self, name: str, kind) -> None:
        if name not in self._lasting:
            super()._alloca_var(name, kind)

    def alloca_lltype(self, name: str, lltype, datamodel=None):
        return cgutils.alloca_once(self.builder, lltype, name=name, zfill=False)

    def storevar(self, value, name: str, argidx: int | None = None) -> None:
        if name in self._lasting:
            self._values[name] = value
        else:
            super().storevar(value, name)

    def loadvar(self, name: str):
        return self._values[name] if name in self._lasting else super().loadvar(name)

    def delvar(self, name: str) -> None:
        if self.context.enable_nrt:
            super().delvar(name)

    def lower_inst(self, inst) -> None:
        if isinstance(inst, ir.SetItem | ir.StaticSetItem):
            kind, item = self.typeof(inst.target.name), self.typeof(inst.value.name)
            found = self._part(inst.target, inst.index) if isinstance(item, types.Number) else None
            if found is not None and not found[1]:
                value = self.context.cast(self.builder, self.loadvar(inst.value.name), item, kind.dtype)
                store_item(self.context, self.builder, kind, value, found[0])
                return
        super().lower_inst(inst)

    def lower_binop(self, resty, expr, op):
        ends = expr.lhs, expr.rhs
        kinds = [self.typeof(each.name) for each in ends]
        if op in (operator.pow, operator.ipow) or not all(isinstance(kind, types.Number) for kind in kinds):
            return super().lower_binop(resty, expr, op)  # which sees what a constant exponent is
        context, builder, signature = self.context, self.builder, self.fndesc.calltypes[expr]
        function_type = context.typing_context.resolve_value_type(op)
        if signature.args not in function_type._impl_keys:  # not typed since numba made this record of it
            return super().lower_binop(resty, expr, op)
        function = context.get_function(function_type, signature)
        values = [
            context.cast(builder, self.loadvar(ends[i].name), kinds[i], signature.args[i]) for i in range(2)
        ]
        return context.cast(builder, function(builder, values), signature.return_type, resty)

    def lower_expr(self, resty, expr):
        if expr.op in ("getitem", "static_getitem"):
            found = self._part(expr.value, expr.index)
            if found is not None and not found[1]:
                kind = self.typeof(expr.value.name)
                value = load_item(self.context, self.builder, kind, found[0])
                return self.context.cast(self.builder, value, kind.dtype, resty)
            if found is not None and not self.context.enable_nrt:
                return array_value(self.builder, *found)
        return super().lower_expr(resty, expr)

    def _part(self, array, index):
        """Return the address, shape and strides of a part of an array; None if left to numba."""
        kind, builder = self.typeof(array.name), self.builder
        if not isinstance(kind, types.Array):
            return None
        fields = self.loadvar(array.name)
        data = builder.extract_value(fields, _DATA)
        shape = cgutils.unpack_tuple(builder, builder.extract_value(fields, _SHAPE), kind.ndim)
        strides = cgutils.unpack_tuple(builder, builder.extract_value(fields, _STRIDES), kind.ndim)
        places = self._places(index)
        if kind.ndim == 1 and isinstance(places[0], tuple):
            first, end = (self._within(place, shape[0]) for place in places[0])
            places, shape = [first], [shape[0], self._larger(_INTP(0), builder.sub(end, first))]
            strides = [strides[0], strides[0]]
        elif not all(isinstance(place, Value) for place in places):
            return None
        places = [self._counted(place, shape[i]) for i, place in enumerate(places)]
        left = shape[len(places) :], strides[len(places) :]
        if kind.layout != "C":
            steps = [builder.mul(place, strides[i]) for i, place in enumerate(places)]
            return cgutils.pointer_add(builder, data, reduce(builder.add, steps)), *left
        offset = places[0]
        for i in range(1, kind.ndim):
            offset = builder.mul(offset, shape[i])
            offset = builder.add(offset, places[i]) if i < len(places) else offset
        return builder.gep(data, [offset]), *left

    def _places(self, index):
        """Return an index's parts: values, pairs of the ends of slices, None for what is left to numba."""
        if not isinstance(index, ir.Var):
            return [_constant(part) for part in (index if isinstance(index, tuple) else (index,))]
        kind = self.typeof(index.name)
        value = self.loadvar(index.name)
        if not isinstance(kind, types.Tuple | types.UniTuple):
            return [self._place(kind, value)]
        parts = cgutils.unpack_tuple(self.builder, value)
        return [self._place(each, parts[i]) for i, each in enumerate(kind.types)]

    def _place(self, kind, value):
        if isinstance(kind, types.Integer):
            return self.context.cast(self.builder, value, kind, types.intp)
        if kind == types.slice2_type:
            return self.builder.extract_value(value, 0), self.builder.extract_value(value, 1)
        return None

    def _counted(self, place, count):
        """Return a place, which below zero is counted from the end."""
        if isinstance(place, Constant) and place.constant >= 0:
            return place
        below = self.builder.icmp_signed("<", place, _INTP(0))
        return self.builder.select(below, self.builder.add(place, count), place)

    def _within(self, place, count):
        """Return an end of a slice, within the array."""
        place = self._larger(_INTP(0), self._counted(place, count))
        return self.builder.select(self.builder.icmp_signed("<", place, count), place, count)

    def _larger(self, a, b):
        return self.builder.select(self.builder.icmp_signed(">", a, b), a, b)


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(NativeLowering):
    """The pass of the compiler that makes the code."""

    _name = "kernel_lowering"
    lowering_class = _Lower


def array_value(builder, data, shape, strides):
    """Return an array of items of eight bytes that owns nothing, as LLVM has it.

    Args:
        builder: of the code.
        data: where it begins.
        shape: its lengths, as LLVM values.
        strides: in bytes.
    """
    none, count = cgutils.get_null_value(cgutils.voidptr_t), reduce(builder.mul, shape)
    ends = (cgutils.pack_array(builder, lengths) for lengths in (shape, strides))
    return cgutils.pack_struct(builder, [none, none, count, _INTP(_ITEM), data, *ends])


def _constant(index):
    """Return a constant index's value, or the ends of a constant slice; None for any other."""
    if isinstance(index, int):
        return _INTP(index)
    if not isinstance(index, slice) or index.step not in (None, 1):
        return None
    return _INTP(index.start or 0), _INTP(sys.maxsize if index.stop is None else index.stop)


def _assigned_once(blocks) -> set[str]:
    """Return the variables with one assignment, which is always passed before they are used."""
    where: dict[str, int] = {}
    others = set()
    for label, block in blocks.items():
        for assign in block.find_insts(ir.Assign):
            if assign.target.name in where:
                others.add(assign.target.name)
            where[assign.target.name] = label
    passed = compute_cfg_from_blocks(blocks).dominators()
    for label, names in compute_use_defs(blocks).usemap.items():
        others |= {name for name in names if where.get(name) not in passed[label]}
    return set(where) - others
