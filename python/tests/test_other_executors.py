"""Runs on executors of other packages, which are skipped where they are missing."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from test_executors import files

import coinmc

SCRIPT = """
import sys
import coinmc

if __name__ == "__main__":
    _, name, config, out = sys.argv
    if name == "mpi":
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as executor:
            coinmc.run(config, out, executor=executor)
    elif name == "executorlib":
        from executorlib import SingleNodeExecutor

        with SingleNodeExecutor(max_workers=2) as executor:
            coinmc.run(config, out, executor=executor)
    else:
        import submitit

        executor = submitit.LocalExecutor(folder="jobs")
        executor.update_parameters(timeout_min=5)
        coinmc.run(config, out, executor=executor)
"""


@pytest.fixture
def folder(scene, tmp_path):
    """A config of three chunks, its local run, and the script."""
    config = coinmc.Config({**scene, "coin": {"ratio": [0.8, 1.4, 2.0]}, "stop": {"tosses": 500}})
    coinmc.run(config, tmp_path / "local")
    (tmp_path / "toss.toml").write_text(config.resolved)
    (tmp_path / "script.py").write_text(SCRIPT)
    return tmp_path


def run(folder, name, *launcher):
    words = [*launcher, "script.py", name, "toss.toml", name]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    assert files(folder / name) == files(folder / "local")


def test_mpi(folder):
    pytest.importorskip("mpi4py", reason="pip install mpi4py mpich")
    beside = Path(sys.executable).parent
    mpiexec = shutil.which("mpiexec", path=os.pathsep.join([str(beside), os.environ["PATH"]]))
    if mpiexec is None:
        pytest.skip("there is no mpiexec: pip install mpich")
    run(folder, "mpi", mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures")


@pytest.mark.parametrize("name", ["executorlib", "submitit"])
def test_jobs(folder, name):
    pytest.importorskip(name, reason=f"pip install {name}")
    run(folder, name, sys.executable)
