"""The compiler's passes that a kernel can need, without the bookkeeping between them that it cannot."""

from __future__ import annotations

from typing import Any

from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.ir_utils import build_definitions
from numba.core.ssa import reconstruct_ssa
from numba.core.typed_passes import (
    AnnotateTypes,
    IRLegalization,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.untyped_passes import (
    DeadBranchPrune,
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    RewriteSemanticConstants,
    TranslateByteCode,
)

from nullpose.solve.kernels.lowering import KernelLowering


class _Passes(PassManager):
    """Passes run one after the other, without numba's checks of what each has left behind."""

    def _runPass(self, index: int, pss: Any, internal_state: Any) -> None:  # noqa: N802  its name
        pss.analysis = self._analysis
        pss.run_pass(internal_state)


@register_pass(mutates_CFG=True, analysis_only=False)
class _SingleAssignment(ReconstructSSA):
    """Numba's, without finding out how long each variable lives."""

    _name = "kernel_single_assignment"

    def run_pass(self, state: Any) -> bool:
        state.func_ir = reconstruct_ssa(state.func_ir)
        self._patch_locals(state)
        state.func_ir._definitions = build_definitions(state.func_ir.blocks)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class _StripPhis(PreLowerStripPhis):
    """Numba's, without finding that out."""

    _name = "kernel_strip_phis"

    def run_pass(self, state: Any) -> bool:
        state.func_ir = self._strip_phi_nodes(state.func_ir)
        return True


@register_pass(mutates_CFG=False, analysis_only=True)
class _Ends(IRLegalization):
    """Note where each variable ends, where references are counted."""

    _name = "kernel_ends"

    def run_pass(self, state: Any) -> bool:
        return not state.targetctx.enable_nrt or super().run_pass(state)


_PASSES = (
    TranslateByteCode,
    FixupArgs,
    IRProcessing,
    RewriteSemanticConstants,
    DeadBranchPrune,
    GenericRewrites,
    _SingleAssignment,
    NopythonTypeInference,
    _StripPhis,
    _Ends,
    AnnotateTypes,
    KernelLowering,
    NoPythonBackend,
)


def passes() -> PassManager:
    """Return them, in their order."""
    manager = _Passes("kernel")
    for each in _PASSES:
        manager.add_pass(each, each._name)
    manager.finalize()
    return manager
