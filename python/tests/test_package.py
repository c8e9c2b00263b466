"""The package as such: stubs, names, imports, documents."""

import ast
import doctest
import importlib
import inspect
import json
import pkgutil
import subprocess
import sys
import time

import pytest

import coinmc
from coinmc import _lib

# Time of `import coinmc` over that of `import numpy`, most of which it is: 1.2 measured (77, 66 ms)
IMPORT_OF_NUMPY = 1.5
HEAVY = (
    "arrow",
    "pandas",
    "polars",
    "pyarrow",
    "matplotlib",
    "scipy",
    "tqdm",
    "dask",
    "cv2",
    "PIL",
)


def modules() -> list[str]:
    found = pkgutil.walk_packages(coinmc.__path__, "coinmc.")
    return ["coinmc", *(module.name for module in found if module.name != "coinmc._lib")]


def stub_of(package) -> ast.Module:
    return ast.parse((package / "_lib.pyi").read_text())


def parameters(node: ast.FunctionDef) -> list[tuple[str, str | None]]:
    arguments = node.args
    others = (arguments.kwonlyargs, arguments.vararg, arguments.kwarg, arguments.posonlyargs)
    assert not any(others)
    defaults = [None] * (len(arguments.args) - len(arguments.defaults))
    defaults += [ast.unparse(default) for default in arguments.defaults]
    names = [argument.arg for argument in arguments.args]
    return list(zip(names, defaults, strict=True))


def test_a_run_directory_records_the_build(tmp_path):
    assert coinmc.__build__.startswith(coinmc.__version__)
    coinmc.run({"coin": {"ratio": 1.0}, "engine": {"analytic": {"rule": "arc"}}}, tmp_path / "run")
    manifest = json.loads((tmp_path / "run/manifest.json").read_text())
    assert manifest["builds"] == [coinmc.__build__]


def real_parameters(function) -> list[tuple[str, str | None]]:
    empty = inspect.Parameter.empty
    return [
        (parameter.name, None if parameter.default is empty else repr(parameter.default))
        for parameter in inspect.signature(function).parameters.values()
    ]


def test_stubs_match_the_module(package):
    """Every name, parameter and default of the stubs is that of the module, and the other way."""
    stub = stub_of(package)
    functions = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    public = {name for name in dir(_lib) if not name.startswith("_")}
    assert {*functions, *classes} == public
    assert {"__build__", "__version__", "_Columns", "_Progress"} == {
        target.id
        for node in stub.body
        if isinstance(node, (ast.AnnAssign, ast.Assign))
        for target in ([node.target] if isinstance(node, ast.AnnAssign) else node.targets)
    }
    for name, node in functions.items():
        assert parameters(node) == real_parameters(getattr(_lib, name)), name
    for name, node in classes.items():
        there = getattr(_lib, name)
        # a constructor is no member that could be compared
        members = {member.name: member for member in node.body if member.name != "__init__"}
        real = {
            member
            for member in vars(there)
            if not member.startswith("__") or member in ("__len__", "__arrow_c_stream__")
        }
        assert set(members) == real, name
        for member, function in members.items():
            decorators = {ast.unparse(decorator) for decorator in function.decorator_list}
            attribute = inspect.getattr_static(there, member)
            assert ("property" in decorators) == inspect.isdatadescriptor(attribute), member
            assert ("staticmethod" in decorators) == isinstance(attribute, staticmethod), member
            if not decorators and not member.startswith("__"):
                assert parameters(function) == real_parameters(getattr(there, member)), member


def test_the_package_is_typed_and_complete(package):
    assert (package / "py.typed").exists()
    for name in modules():
        module = importlib.import_module(name)
        assert module.__doc__, name
        assert module.__all__ == sorted(module.__all__, key=_order), name
        for public in module.__all__:
            assert getattr(module, public) is not None, (name, public)


def _order(name: str) -> tuple[int, str]:
    """Constants, classes, functions: as ruff sorts."""
    bare = name.strip("_")
    kind = 0 if bare.isupper() else 1 if bare[:1].isupper() and not name.startswith("_") else 2
    return kind, name


def test_everything_public_is_documented():
    for name in modules():
        module = importlib.import_module(name)
        for public in module.__all__:
            thing = getattr(module, public)
            if inspect.isclass(thing) or inspect.isfunction(thing):
                assert inspect.getdoc(thing), (name, public)


@pytest.mark.parametrize("name", modules())
def test_examples_in_docstrings(name, root, tmp_path, monkeypatch):
    """In a folder of their own, beside the examples, since some write files."""
    (tmp_path / "examples").symlink_to(root / "examples")
    monkeypatch.chdir(tmp_path)
    if name.startswith("coinmc.plot"):
        import matplotlib as mpl

        mpl.use("Agg")
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    failed, _ = doctest.testmod(importlib.import_module(name), optionflags=options)
    assert failed == 0


def test_import_loads_no_heavy_module():
    program = (
        "import sys; before = set(sys.modules); import coinmc; print(*set(sys.modules) - before)"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    names = {module.split(".")[0] for module in loaded.stdout.split()}
    assert not names & set(HEAVY)


def test_import_takes_little_longer_than_numpy():
    """Side by side, in turns: on a busy machine both are slow. benches/python tells the times."""
    timed = "import time; t = time.process_time(); import {}; print(time.process_time() - t)"
    least = {"numpy": float("inf"), "coinmc": float("inf")}
    for _ in range(8):
        for name, before in least.items():
            command = [sys.executable, "-c", timed.format(name)]
            told = subprocess.run(command, check=True, capture_output=True)
            least[name] = min(before, float(told.stdout))
    assert least["coinmc"] < IMPORT_OF_NUMPY * least["numpy"]


def test_the_wheel_is_small(package):
    from importlib.metadata import distribution, requires

    files = distribution("coinmc").files
    size = sum((package.parent / file).stat().st_size for file in files)
    # a quarter of it is the command line; unpacked: what is downloaded is two fifths of it
    assert size < 26 << 20
    needed = [line for line in requires("coinmc") if "extra" not in line]
    assert [line.split(">")[0] for line in needed] == ["numpy"]


def test_short_work_is_fast(scene):
    """A call costs less than a millisecond beside its tosses: best of many."""
    config = coinmc.Config(scene)
    times = []
    for _ in range(50):
        begun = time.perf_counter()
        coinmc.toss(config, 1)
        times.append(time.perf_counter() - begun)
    assert min(times) < 1e-3
