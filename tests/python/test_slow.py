"""tools/slow: every check ends with its own line, whether it passes, fails, is skipped, hangs or is broken;
the exit status sums them up."""

from __future__ import annotations

import runpy
import subprocess
import sys

import pytest
from conftest import SOURCE

SCRIPT = SOURCE / "tools/slow"
slow = runpy.run_path(str(SCRIPT))
Check, main = slow["Check"], slow["main"]


def raises(error):
    def check(log):
        raise error

    return check


CHECKS = [
    Check("command", 1, "a command that passes", (sys.executable, "-c", "print('first'); print('12 of 12')")),
    Check("function", 1, "a function that passes",
          lambda log: "found 7, status " + log.run(sys.executable, "-c", "print(0)").strip()),
    Check("absent", 1, "a command that is skipped", (sys.executable, "-c", "print('no qemu'); exit(77)")),
    Check("broken", 1, "a command that fails", (sys.executable, "-c", "print('3 differ'); exit(1)")),
    Check("unmet", 1, "a function that finds something", raises(slow["Failed"]("0.1 is not above 0.2"))),
    Check("mistaken", 1, "a function with a mistake", raises(ZeroDivisionError("division"))),
    Check("endless", 0.0005, "a command that hangs", (sys.executable, "-c", "import time; time.sleep(60)")),
    Check("nothing", 1, "a program that is not there", ("/no/such/program",)),
    Check("lacking", 1, "something is missing",
          lambda log: log.run(sys.executable, "-c", "exit('no network')", lacks="pip cannot get it")),
]


@pytest.mark.parametrize(
    ("name", "result", "said", "status"),
    [
        ("command", "PASS", "12 of 12", 0),
        ("function", "PASS", "found 7, status 0", 0),
        ("absent", "SKIPPED", "no qemu", 0),
        ("broken", "FAIL", "status 1: 3 differ", 1),
        ("unmet", "FAIL", "0.1 is not above 0.2", 1),
        ("mistaken", "FAIL", "ZeroDivisionError: division", 1),
        ("endless", "FAIL", "it did not end in time", 1),
        ("nothing", "FAIL", "/no/such/program: No such file", 1),
        ("lacking", "SKIPPED", "pip cannot get it: no network", 0),
    ],
)
def test_a_check_ends_with_its_line(name, result, said, status, tmp_path, capsys):
    assert main([name], CHECKS, tmp_path) == status
    line, summary = capsys.readouterr().out.splitlines()
    assert line.split()[:2] == [result, name] and line.partition("min")[2].strip().startswith(said)
    passed, failed, skipped = (int(result == each) for each in ("PASS", "FAIL", "SKIPPED"))
    assert summary == f"slow: {passed} passed, {failed} failed, {skipped} skipped"
    assert (tmp_path / "report.txt").read_text().splitlines() == [line, summary]
    assert (tmp_path / f"{name}.log").is_file()


def test_a_failure_ends_the_run_unless_it_may_continue(tmp_path, capsys):
    names = ["absent", "broken", "command"]
    assert main(names, CHECKS, tmp_path) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "slow: 0 passed, 1 failed, 1 skipped, 1 not run"
    assert main(["--keep-going", *names], CHECKS, tmp_path) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "slow: 1 passed, 1 failed, 1 skipped"


def test_the_command_lists_its_checks_and_refuses_others():
    def run(*arguments):
        return subprocess.run(
            [sys.executable, SCRIPT, *arguments], capture_output=True, text=True, check=False)

    listed = run("--list")
    assert listed.returncode == 0
    names = [line.split()[0] for line in listed.stdout.splitlines()]
    assert names == [check.name for check in slow["CHECKS"]]
    assert "exit status" in run("--help").stdout.lower()
    for wrong in ("laerning", "--lsit"):
        done = run(wrong)
        assert done.returncode == 2 and f"no check or option '{wrong}'" in done.stderr and done.stdout == ""
