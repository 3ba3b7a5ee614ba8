"""How numba compiles functions that only other compiled functions call.

numba optimises every function together with all that it calls, turns it into machine code, and does the
same again for each of its callers: compile time grows with the square of the depth of calls, and was four
times as long for this package. A function made with ``InnerCompiler`` is not optimised by itself. It becomes
part of the functions that Python calls (``compiled.compiled``), which are optimised as a whole.
"""

from collections.abc import Callable
from typing import Any, ClassVar, cast

from llvmlite.binding import create_new_function_pass_manager
from numba.core import compiler, event, sigutils, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_machinery import LoweringPass, PassManager, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.typing.context import Context
from numba.core.untyped_passes import (
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    TranslateByteCode,
)


class _InnerLibrary(JITCodeLibrary):
    """Code that is linked, with all that it calls itself, into the functions that Python calls.

    If it were linked into every caller on the way as well, it would be copied once for each level of calls.
    """

    def _optimize_functions(self, ll_module: Any) -> None:
        """Move variables from memory to registers before the code is copied into callers."""
        ll_module.data_layout = self._codegen._data_layout
        passes = create_new_function_pass_manager()
        passes.add_sroa_pass()
        builder = self._codegen._pass_builder()
        for function in ll_module.functions:
            if not function.is_declaration:
                passes.run(function, builder)

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


def _refuse_arrays(state: Any) -> None:
    """Raise TypeError if a function returns arrays, or calls one that does: they need reference counts."""
    counted = state.targetctx.data_model_manager.lookup
    calls = (expression for expression in state.calltypes if getattr(expression, "op", "") == "call")
    made = [
        state.calltypes[each].return_type
        for each in calls
        if isinstance(state.typemap[each.func.name], types.Dispatcher)
    ]
    for kind in (state.return_type, *made):
        if counted(kind).contains_nrt_meminfo():
            raise TypeError(f"{state.func_id.func_qualname}: arrays are for functions marked allocating")


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(NativeLowering):
    """Lowering to code without an address."""

    _name = "inner_lowering"

    def run_pass(self, state: Any) -> bool:
        if not state.flags.nrt:
            _refuse_arrays(state)
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


class _TypingContext(Context):
    """numba's typing context, which keeps what it infers for operators and functions of numbers.

    numba infers them anew for every use: it tries templates for arrays, strings and dates first.
    """

    known: ClassVar[dict[tuple, Any]] = {}

    def __init__(self, shared: Context) -> None:
        self.__dict__ = shared.__dict__

    def resolve_function_type(self, function: Any, arguments: tuple, keywords: Any) -> Any:
        of_numbers = all(isinstance(each, types.Number | types.Boolean) for each in arguments)
        if keywords or not of_numbers or not isinstance(function, types.Function):
            return super().resolve_function_type(function, arguments, keywords)
        call = function, arguments
        if call not in self.known:
            self.known[call] = super().resolve_function_type(*call, keywords)
        return self.known[call]


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerTypeInference(NopythonTypeInference):
    """Type inference in a context of its own."""

    _name = "inner_type_inference"

    def run_pass(self, state: Any) -> bool:
        shared, state.typingctx = state.typingctx, _TypingContext(state.typingctx)
        try:
            return bool(super().run_pass(state))
        finally:
            state.typingctx = shared


@register_pass(mutates_CFG=True, analysis_only=False)
class _AllSteps(LoweringPass):
    """The whole compilation of an inner function, as one of numba's passes.

    What numba does around each pass (texts of types for events, clocks, checks) costs as much as some of
    these steps. It leaves out steps for what these functions do without, each of which costs as much as
    lowering a short function: closures, ``with``, array expressions, literals, raised exceptions.
    """

    _name = "inner"

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        for step in _STEPS:
            # It marks where variables end: only references are released there.
            if step is not IRLegalization or state.flags.nrt:
                step().run_pass(state)
        return True


_STEPS: tuple[type, ...] = (
    TranslateByteCode,
    FixupArgs,
    IRProcessing,
    GenericRewrites,
    ReconstructSSA,
    _InnerTypeInference,
    PreLowerStripPhis,
    IRLegalization,
    _InnerLowering,
    NoPythonBackend,
)


class InnerCompiler(compiler.CompilerBase):
    """numba's compiler, with the last step left to the callers."""

    def define_pipelines(self) -> list:
        pipeline = PassManager("inner")
        pipeline.add_pass(_AllSteps, _AllSteps.__name__)
        pipeline.finalize()
        return [pipeline]


class InnerDispatcher(CPUDispatcher):
    """Compiles a function once for all constants among its arguments.

    numba would compile it anew for each of them, and every compiled function would listen to the times of all
    that it calls.
    """

    def get_call_template(self, args: Any, kws: Any) -> Any:
        kws = {name: types.unliteral(kind) for name, kind in dict(kws).items()}
        return super().get_call_template(tuple(map(types.unliteral, args)), kws)

    def compile(self, sig: Any) -> Any:
        arguments, result = sigutils.normalize_signature(sig)
        known: Any = self.overloads.get(tuple(arguments))
        if known is None:
            # Those who announce compilation listen.
            with event.trigger_event("numba:compile", data={"dispatcher": self, "args": arguments}):
                known = cast(Any, self)._compiler.compile(arguments, result)
            self.add_overload(known)
        return known.entry_point


def compile_inner(function: Callable, options: dict[str, Any]) -> InnerDispatcher:
    """A function that compiled code can call, and is compiled when it does."""
    targets = {"nopython": True} | {key: options[key] for key in options if key != "pipeline_class"}
    return InnerDispatcher(function, targetoptions=targets, pipeline_class=InnerCompiler)
