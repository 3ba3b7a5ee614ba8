"""How numba compiles functions that only other compiled functions call.

numba optimises every function together with all that it calls, turns it into machine code, and does the
same again for each of its callers: compile time grows with the square of the depth of calls, and was four
times as long for this package. A function made with ``InnerCompiler`` is not optimised by itself. It becomes
part of the functions that Python calls (``compiled.compiled``), which are optimised as a whole.
"""

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering


class _InnerLibrary(JITCodeLibrary):
    """Code that is linked, with all that it calls itself, into the functions that Python calls.

    Linked into every caller on the way, too, it would be copied as often as calls are deep.
    """

    def _optimize_functions(self, ll_module: Any) -> None:
        pass

    def finalize(self) -> None:
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration:
                function.linkage = "linkonce_odr"
        self._shared_module = self._final_module
        self._finalize_dynamic_globals()
        self._finalized = True

    def with_called(self) -> list:
        """Itself and all the code that it needs."""
        return list(dict.fromkeys([self, *self._linking_libraries]))


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(NativeLowering):
    """Lowering to code without an address."""

    _name = "inner_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _InnerLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        # numba identifies compiled code by its entry point. This one is unique, and raises an exception if
        # Python calls it.
        entry = (object(),).index
        if not state.flags.forceinline:
            # An integrator with copies of all that it calls is a hundred times as long and takes minutes to
            # optimise.
            name = state["cr"].fndesc.llvm_func_name
            state.library.get_function(name).add_function_attribute("noinline")
        state.targetctx.insert_user_function(entry, state["cr"].fndesc, state.library.with_called())
        state["cr"] = state["cr"]._replace(cfunc=entry)
        return True


class InnerCompiler(CompilerBase):
    """numba's compiler, with the last step left to the callers."""

    def define_pipelines(self) -> list:
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        lowering = [step for step, _ in pipeline.passes].index(NativeLowering)
        pipeline.passes[lowering] = (_InnerLowering, pipeline.passes[lowering][1])
        pipeline.finalize()
        return [pipeline]
