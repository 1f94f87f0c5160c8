"""Kernels that are optimised once, with all that they call, and not again in each of their callers.

As numba has it, every function is optimised and turned into machine code by itself, and again in whatever
calls it, so that what lies ten calls deep is done ten times. Here a kernel is compiled as a *whole* where
Python calls it, and as a *part* where kernels do: a part is lowered and no more, and is optimised within the
whole.
"""

from __future__ import annotations

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.registry import CPUDispatcher

__all__ = ["LinkedDispatcher", "entry_of"]


class _Whole(JITCodeLibrary):
    """Machine code of a kernel and of all its parts."""

    def add_linking_library(self, library: Any) -> None:
        super().add_linking_library(library)
        if isinstance(library, _Part):  # which holds nothing but itself
            self._linking_libraries += library._linking_libraries


class _Part(_Whole):
    """Code of one kernel, to be linked into others."""

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        return 0  # there is no machine code

    @property
    def codegen(self) -> Any:
        return self

    def set_env(self, name: str, env: Any) -> None:
        """Do nothing: an environment belongs to machine code."""


class _Compiler(CompilerBase):
    library: Any = _Whole

    def define_pipelines(self) -> list[Any]:
        state = self.state
        state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return [DefaultPassBuilder.define_nopython_pipeline(state)]


class _PartCompiler(_Compiler):
    library = _Part


class LinkedDispatcher(CPUDispatcher):
    """A kernel: a whole where Python calls it, a part where a kernel does."""

    def __init__(self, function: Any, options: dict[str, Any]) -> None:
        super().__init__(function, targetoptions=options, pipeline_class=_Compiler)
        self.entries: list[Any] = []
        part = options | {"no_cpython_wrapper": True}
        self._part = CPUDispatcher(function, targetoptions=part, pipeline_class=_PartCompiler)

    @property
    def _numba_type_(self) -> Any:
        return self._part._numba_type_

    def add_overload(self, cres: Any) -> None:
        """Keep the machine code for one choice of types."""
        super().add_overload(cres)
        self.entries.append(cres.entry_point)


def entry_of(kernel: Any) -> Any:
    """Return what Python calls where a kernel's arguments are always of the same types.

    That is its machine code, once it is compiled: to choose by types, which for named tuples takes as long
    as a short kernel, is left out.

    Args:
        kernel: any.
    """
    entries: list[Any] = getattr(kernel, "entries", [])
    return entries[0] if len(entries) == 1 else kernel
