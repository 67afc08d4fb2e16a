"""Runs the commands of docs/guide/clusters.md that need the package, as printed; docs_test runs the rest."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys

import pytest
from conftest import HANGS, SOURCE, not_printed

pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
pytest.importorskip("distributed", reason="distributed is not installed: pip install distributed")
pytest.importorskip("dask_jobqueue", reason="dask-jobqueue is not installed: pip install dask-jobqueue")

PAGE = SOURCE / "docs/guide/clusters.md"
BLOCK = re.compile(
    r"^<!-- not run by the tests: tests/python/test_sweep_page.py runs it.*? -->\n```sh\n(.*?)^```$"
    r"(?:\n```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)
# Starts the job at once.
SBATCH = """#!/bin/bash
bash "$1" >/dev/null 2>&1 &
echo Submitted batch job 1
"""


def run(code, folder, bin_folder):
    """Runs a block to its end, then ends its processes; schedulers and workers need a while for that."""
    out, err = folder / "out", folder / "err"
    with out.open("w") as stdout, err.open("w") as stderr:
        environment = os.environ | {"PATH": f"{bin_folder}:{os.environ['PATH']}:/usr/bin:/bin"}
        shell = subprocess.Popen(["/bin/bash", "-euo", "pipefail", "-c", code], cwd=folder, env=environment,
                                 stdout=stdout, stderr=stderr, start_new_session=True)
    try:
        status = shell.wait(timeout=HANGS)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(shell.pid, signal.SIGKILL)
    return status, out.read_text(), err.read_text()


def test_commands_print_the_output_on_the_page(tmp_path):
    (tmp_path / "scenes").symlink_to(SOURCE / "scenes")
    bin_folder = tmp_path / "bin"
    bin_folder.mkdir()
    scripts = {
        "python": f'#!/bin/sh\nexec {sys.executable} "$@"\n',
        "dask": f'#!/bin/sh\nexec {sys.executable} -m dask "$@"\n',
        "sbatch": SBATCH,
        "scancel": "#!/bin/sh\n",
    }
    for name, text in scripts.items():
        (bin_folder / name).write_text(text)
        (bin_folder / name).chmod(0o755)
    blocks = BLOCK.findall(PAGE.read_text())
    assert len(blocks) == 4
    for code, wanted in blocks:
        code = code.replace("cores=16, processes=16", "cores=1, processes=1")
        code_status, out, err = run(code, tmp_path, bin_folder)
        assert code_status == 0, (code, out, err)
        assert not not_printed(wanted, out), (out, err)
    check = subprocess.run([sys.executable, "-m", "carom.sweep", "breaks.json", "--check"], cwd=tmp_path,
                           capture_output=True, text=True, check=False)
    assert check.returncode == 0, check.stdout + check.stderr
