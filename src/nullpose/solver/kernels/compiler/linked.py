"""Kernels that are optimised once, with all that they call, and not again in each of their callers.

As numba has it, every function is optimised and turned into machine code by itself, and again in whatever
calls it, so that what lies ten calls deep is done ten times. Here a kernel is compiled as a *whole* where
Python calls it, and as a *part* where kernels do: a part is lowered and no more, and is optimised within the
whole. Of the compiler's passes only those are run that a kernel can need.
"""

from __future__ import annotations

import pickle
from contextlib import suppress
from functools import cached_property, partial
from hashlib import sha256
from pathlib import Path

from llvmlite import binding
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.registry import CPUDispatcher
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from nullpose.solver.kernels.compiler import interpreted
from nullpose.solver.kernels.compiler.jit import digest_of_sources
from nullpose.solver.kernels.compiler.notices import UNCACHED, warn_once

_CHECKSUM = 32  # bytes


class _Whole(JITCodeLibrary):
    """Machine code of a kernel and of all its parts."""

    def add_linking_library(self, library) -> None:
        super().add_linking_library(library)
        if isinstance(library, _Part):  # which holds nothing but itself
            self._linking_libraries += library._linking_libraries

    def _optimize_final_module(self) -> None:
        """Optimise; parts, which nothing else can call, lose the arguments that they do not use."""
        for function in self._final_module.functions:
            if function.linkage == binding.Linkage.linkonce_odr:
                function.linkage = binding.Linkage.internal
        super()._optimize_final_module()


class _Part(_Whole):
    """Code of one kernel, to be linked into others."""

    def _optimize_functions(self, ll_module) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        return 0  # there is no machine code

    @property
    def codegen(self):
        return self

    def set_env(self, name: str, env) -> None:
        """Do nothing: an environment belongs to machine code."""


class _Compiler(CompilerBase):
    library = _Whole

    def define_pipelines(self):
        from nullpose.solver.kernels.compiler.passes import passes  # a part of the compiler

        state = self.state
        state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return [passes()]


class _PartCompiler(_Compiler):
    library = _Part


class Part:
    """A kernel as other kernels link it in; nothing is made of it before the first of them is compiled."""

    def __init__(self, function, options: dict[str, object]) -> None:
        self.py_func, self._options = function, options
        self.makes_arrays = options["_nrt"]

    @cached_property
    def _dispatcher(self):
        options = self._options | {"no_cpython_wrapper": True}
        return CPUDispatcher(self.py_func, targetoptions=options, pipeline_class=_PartCompiler)

    @property
    def _numba_type_(self):
        return self._dispatcher._numba_type_


class _Stored(CompileResultCacheImpl):
    """What the cache holds of a kernel."""

    def reduce(self, cres):
        """Return machine code alone.

        Nothing links a whole: of its bitcode only the two names that it is entered by are read.
        Environments hold constants for Python: to load one without any imports its module for nothing.
        """
        (name, kind, (code, _)), described, *rest, environments = super().reduce(cres)
        entries = described.llvm_func_name, described.llvm_cpython_wrapper_name
        names = binding.parse_assembly("\n".join(f'@"{each}" = global i8 0' for each in entries))
        used = [each for each in environments if each.consts]
        return (name, kind, (code, names.as_bitcode())), described, *rest, used


class _Files(IndexDataCacheFile):
    """A file of its own for each kernel and choice of types, which begins with the checksum of the rest.

    Numba's have none: a byte that the disk has lost or changed would be run.
    """

    def _path(self, key) -> Path:
        # a process that began with other sources may still be writing
        stamps = self._version, self._source_stamp, digest_of_sources()
        choice = sha256(repr((*stamps, key)).encode()).hexdigest()
        return Path(self._cache_path) / self._index_name.replace(".nbi", f".{choice}.nbc")

    def load(self, key):
        """Load a kernel; None where there is none, or where its file is damaged."""
        with suppress(OSError):
            content = self._path(key).read_bytes()
            if sha256(content[_CHECKSUM:]).digest() == content[:_CHECKSUM]:
                return pickle.loads(content[_CHECKSUM:])
        return None

    def save(self, key, data) -> None:
        """Save, in place of what was there."""
        content = dumps(data)
        with self._open_for_write(self._path(key)) as file:
            file.write(sha256(content).digest() + content)


class _Cache(FunctionCache):
    """Kernels on disk."""

    _impl_class = _Stored

    def __init__(self, function) -> None:
        super().__init__(function)
        numba = self._cache_file
        self._cache_file = _Files(numba._cache_path, self._impl.filename_base, numba._source_stamp)

    def holds(self, sig, target_context) -> bool:
        """Check for machine code that can be loaded."""
        return self._cache_file.load(self._index_key(sig, target_context.codegen())) is not None

    def load_overload(self, sig, target_context):
        """Load machine code without the compiler, which numba would load too; None where there is none."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def save_overload(self, sig, data) -> None:
        """Save machine code; where that cannot be, say so once."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            warn_once(f"Kernels cannot be kept in {self.cache_path}: {error.strerror}. {UNCACHED}")


class LinkedDispatcher(CPUDispatcher):
    """A kernel: a whole where Python calls it, a part where a kernel does."""

    def __init__(self, function, options: dict[str, object]) -> None:
        super().__init__(function, targetoptions=options, pipeline_class=_Compiler)
        self.entry: object = self  # or machine code, once it is there
        self._part = Part(function, options)
        self.makes_arrays = self._part.makes_arrays

    @property
    def _numba_type_(self):
        return self._part._numba_type_

    def enable_caching(self) -> None:
        """Keep machine code on disk."""
        self._cache = _Cache(self.py_func)

    def compile(self, sig):
        """Return machine code for arguments of given types, or Python while that is not there."""
        compiler = interpreted.compiler
        if compiler is None or self.has_code(sig) or not compiler.takes(self, sig):
            return super().compile(sig)
        return partial(interpreted.interpret, self, sig)

    def has_code(self, sig) -> bool:
        """Check for machine code for arguments of given types, in this process or on disk."""
        is_kept = isinstance(self._cache, _Cache) and self._cache.holds(sig, self.targetctx)
        return is_kept or tuple(sig) in self.overloads

    def add_overload(self, cres) -> None:
        """Keep the machine code for one choice of types."""
        super().add_overload(cres)
        self.entry = cres.entry_point
