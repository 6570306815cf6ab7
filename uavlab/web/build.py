"""Makes `planners.wasm` from `functions`: numba's IR, for another machine.

numba gives each function as LLVM IR, for the machine that it runs on. Unoptimised, that IR knows pointers as pointers
and structures as structures, so the same text is right for WebAssembly, where pointers have 32 bits; LLVM optimises it
there, and `wasm-ld` links it. What numba's runtime does is left to the page: it hands in memory, and mathematics that
WebAssembly doesn't have, such as exp. Needs `wasm-ld` (Debian's package lld); who uses the module doesn't.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Container, Mapping
from pathlib import Path
from typing import Any, get_type_hints

from uavlab import __version__

TARGET = "wasm32-unknown-unknown"
WASM, FACTS = (Path(__file__).with_name(name) for name in ("planners.wasm", "planners.json"))
PLAIN = {
    "NUMBA_OPT": "0", "NUMBA_LOOP_VECTORIZE": "0", "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_JIT": "0", "PYTHONHASHSEED": "0",
}  # fmt: skip
"""How numba has to be set up before it is imported, for IR that any machine can have, and the same each time."""

RUNTIME = """
define void @NRT_incref(ptr %block) noinline {
  %none = icmp eq ptr %block, null
  br i1 %none, label %end, label %more
more:
  %count = load i64, ptr %block
  %next = add i64 %count, 1
  store i64 %next, ptr %block
  br label %end
end:
  ret void
}
define void @NRT_decref(ptr %block) noinline {
  %none = icmp eq ptr %block, null
  br i1 %none, label %end, label %less
less:
  %count = load i64, ptr %block
  %next = sub i64 %count, 1
  store i64 %next, ptr %block
  %last = icmp eq i64 %next, 0
  br i1 %last, label %free, label %end
free:
  call void @NRT_MemInfo_call_dtor(ptr %block)
  br label %end
end:
  ret void
}
define { i64, i1 } @product(i64 %one, i64 %other) alwaysinline {
  %product = mul i64 %one, %other
  %answer = insertvalue { i64, i1 } { i64 0, i1 false }, i64 %product, 0
  ret { i64, i1 } %answer
}
define i32 @numba_attempt_nocopy_reshape(i64, ptr, ptr, i64 %axes, ptr %lengths, ptr %strides, i64 %item, i32) {
start:
  br label %each
each:
  %left = phi i64 [ %axes, %start ], [ %axis, %next ]
  %stride = phi i64 [ %item, %start ], [ %wider, %next ]
  %done = icmp eq i64 %left, 0
  br i1 %done, label %end, label %next
next:
  %axis = sub i64 %left, 1
  %place = getelementptr i64, ptr %strides, i64 %axis
  store i64 %stride, ptr %place
  %from = getelementptr i64, ptr %lengths, i64 %axis
  %length = load i64, ptr %from
  %wider = mul i64 %stride, %length
  br label %each
end:
  ret i32 1
}
declare void @NRT_MemInfo_call_dtor(ptr)
"""
"""What numba does otherwise: it counts who uses a block of memory with atomic instructions, though a page has one
thread; looks whether an array has more than 2⁶³ bytes, and whether its rows follow each other, as all on a page do."""


REWRITTEN = (
    (r'target (triple|datalayout) = "[^\n]*\n', ""),
    (r'"target-(cpu|features)"="[^"]*"', ""),
    (r"define [^\n]*@(NRT_incref|NRT_decref)(\([^\n]*?\))[^\n]*\{.*?\n\}\n", r"declare void @\1(ptr)\n"),
    (r"define [^\n]*@nrt_atomic_\w+\([^\n]*\{.*?\n\}\n", ""),
    (r"@llvm\.smul\.with\.overflow\.i64\(", "@product("),
    (r"= common ", "= linkonce_odr "),
    # the text of numba's errors takes more room than the planners, and a page needs to know only of one
    (
        r'define linkonce_odr (i32 @"?[^\s"(]*raise_with_shape_context[^\s"(]*"?\([^\n]*\)) *(?:#\d+ *)?\{.*?\n\}\n',
        r"declare \1\n",
    ),
    (r"(?<!\n)@\.const\.picklebuf\.[\w.]+", "null"),
)
"""What in numba's IR is for the machine that it runs on."""


def main() -> None:
    """Build the module and the facts on it, in a fresh process, as numba reads its settings when it is imported."""
    with tempfile.TemporaryDirectory() as cache:
        settings = os.environ | PLAIN | {"NUMBA_CACHE_DIR": cache}
        subprocess.run([sys.executable, "-c", "from uavlab.web.build import build; build()"], env=settings, check=True)


def build(wasm: Path = WASM, facts: Path = FACTS) -> None:
    """Write the module, and beside it what made it and what its functions take."""
    import llvmlite
    import numba

    from uavlab.web.functions import ANSWERS

    if shutil.which("wasm-ld") is None:
        raise RuntimeError("wasm-ld isn't there: it links the module; on Debian it comes with the package lld")
    chosen = functions()
    with tempfile.TemporaryDirectory() as folder:
        compiled = Path(folder, "planners.o")
        compiled.write_bytes(machine_code(chosen))
        exports = [f"--export={name}" for name in (*chosen, "__heap_base")]
        options = ["--no-entry", "--allow-undefined", "--gc-sections", "--strip-all", *exports]
        subprocess.run(["wasm-ld", *options, "-o", str(wasm), str(compiled)], check=True)
    wasm.chmod(0o644)
    linker = subprocess.run(["wasm-ld", "--version"], capture_output=True, text=True, check=True).stdout
    made_by = {"uavlab": __version__, "numba": numba.__version__, "llvmlite": llvmlite.__version__}
    made_by["lld"] = re.findall(r"[\d.]+\d", linker)[0]
    signatures = {}
    for name, function in chosen.items():
        takes = [[argument, *kind_of(hint)] for argument, hint in arguments_of(function).items()]
        signatures[name] = {"takes": takes, "gives": kind_of(result_of(function))[0]}
    digest = hashlib.sha256(wasm.read_bytes()).hexdigest()
    told = {"made_by": made_by, "digest": digest, "answers": ANSWERS, "functions": signatures}
    facts.write_text(json.dumps(told) + "\n")


def machine_code(chosen: Mapping[str, Any]) -> bytes:
    """The functions and all that they call, optimised for WebAssembly, as an object file."""
    import llvmlite.binding as llvm

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    machine = llvm.Target.from_triple(TARGET).create_target_machine(opt=3)
    head = f'target datalayout = "{machine.target_data}"\ntarget triple = "{TARGET}"\n'
    whole = llvm.parse_assembly(head)
    for name, function in chosen.items():
        whole.link_in(llvm.parse_assembly(head + intermediate(name, function)))
    hide_all_but(whole, chosen)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_unrolling = False
    passes = llvm.create_pass_builder(machine, tuning)
    first = llvm.create_new_module_pass_manager()
    for add in (
        first.add_sroa_pass, first.add_instruction_combine_pass, first.add_simplify_cfg_pass, first.add_refprune_pass,
    ):  # fmt: skip
        add()
    first.run(whole, passes)  # while calls that count can still be seen as such
    whole.link_in(llvm.parse_assembly(head + RUNTIME))
    hide_all_but(whole, chosen)
    passes.getModulePassManager().run(whole, passes)
    return machine.emit_object(whole)


def functions() -> dict[str, Any]:
    """By name, those that a page can call: all with types."""
    from uavlab.web import functions as there

    mine = {name: one for name, one in vars(there).items() if getattr(one, "__module__", "") == there.__name__}
    return {name: one for name, one in mine.items() if hasattr(one, "py_func") and one.__annotations__.get("return")}


def arguments_of(function: Any) -> dict[str, Any]:
    return {
        name: hint for name, hint in get_type_hints(function.py_func, include_extras=True).items() if name != "return"
    }


def result_of(function: Any) -> Any:
    return get_type_hints(function.py_func)["return"]


def kind_of(hint: Any) -> tuple[str, int]:
    """Type and number of axes; 0 for one number."""
    if hasattr(hint, "__metadata__"):
        return hint.__metadata__
    return {int: "int32", float: "float64", bool: "int32"}[hint], 0


def intermediate(name: str, function: Any) -> str:
    """The IR of a function that takes arrays as a pointer and the length of each axis."""
    from numba import carray, njit, types

    taken, types_taken, passed = [], [], []
    for argument, hint in arguments_of(function).items():
        kind, axes = kind_of(hint)
        lengths = [f"{argument}_{axis}" for axis in range(axes)]
        taken += [argument, *lengths]
        types_taken += [types.CPointer(getattr(types, kind)) if axes else getattr(types, kind)] + [types.int32] * axes
        number = f"int({argument})" if kind == "int32" else argument
        passed.append(f"carray({argument}, ({', '.join(lengths)},))" if axes else number)
    namespace: dict[str, Any] = {"carray": carray, "function": function}
    exec(f"def {name}({', '.join(taken)}):\n    return function({', '.join(passed)})", namespace)
    entry = njit(error_model="numpy")(namespace[name])
    entry.compile(tuple(types_taken))
    result: Any = next(iter(entry.overloads.values()))
    text = result.library.get_llvm_str().replace(result.fndesc.llvm_func_name, name)
    for unwanted, instead in REWRITTEN:
        text = re.sub(unwanted, instead, text, flags=re.DOTALL)
    return text


def hide_all_but(module: Any, names: Container[str]) -> None:
    """Let everything else be merged, inlined or dropped."""
    for function in module.functions:
        if not function.is_declaration:
            function.linkage = "external" if function.name in names else "internal"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"


if __name__ == "__main__":
    main()
