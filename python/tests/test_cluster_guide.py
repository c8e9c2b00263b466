"""The commands of docs/guide/cluster.md, in order, with a Slurm that runs its jobs at once."""

import os
import re
import shutil
import subprocess

SBATCH = """#!/bin/sh
# runs the jobs of an array, one after the other
array=$(sed -n 's/^#SBATCH --array=//p' array.sh)
for argument; do
    case $argument in --array=*) array=${argument#--array=} ;; esac
done
for range in $(echo "$array" | tr , ' '); do
    for job in $(seq "${range%-*}" "${range#*-}"); do
        SLURM_ARRAY_TASK_ID=$job sh array.sh > "job-$job.txt" || exit 1
    done
done
"""


def test_every_command_of_the_guide_works(root, program, tmp_path):
    text = (root / "docs" / "guide" / "cluster.md").read_text()
    blocks = re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 6
    shutil.copytree(root / "examples", tmp_path / "examples")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "sbatch").write_text(SBATCH)
    (tmp_path / "bin" / "sbatch").chmod(0o755)
    path = os.pathsep.join([str(tmp_path / "bin"), str(program.parent), os.environ["PATH"]])
    script = "set -eu\n" + "\n".join(blocks)
    done = subprocess.run(
        ["sh", "-c", script],
        cwd=tmp_path,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "something is missing" in done.stdout
    assert "sbatch --array=1-" in done.stdout
    assert '"parts": [\n    "3/4"\n  ]' in (tmp_path / "missing.json").read_text()
