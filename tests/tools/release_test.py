#!/usr/bin/env python3
"""Tests tools/release on a copy of its inputs: it finds every kind of fault, and the release it makes has
none. Usage: release_test.py"""
import contextlib
import datetime
import importlib.machinery
import importlib.util
import io
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("release", str(ROOT / "tools/release"))
release = importlib.util.module_from_spec(importlib.util.spec_from_loader("release", loader))
loader.exec_module(release)
READ = {name for name, _ in release.PLACES} | {"CHANGELOG.md", release.PROMISED, "capi/include/carom/carom.h",
                                               "web/npm/index.d.ts", "docs/reference/record.schema.json",
                                               "tests/data/engine/golden_hashes.json",
                                               *(f"games/src/{game}.cpp" for game in (
                                                   "eight_ball", "nine_ball", "ten_ball", "snooker",
                                                   "carom_games"))}


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in READ:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)

    def change(self, name, pattern, by, count=1):
        text = (self.root / name).read_text()
        new = re.sub(pattern, by, text, count=count)
        self.assertNotEqual(new, text, f"{name} has no {pattern}")
        (self.root / name).write_text(new)

    def one_fault(self, words):
        faults = release.faults_of(self.root)
        self.assertEqual(len(faults), 1, faults)
        self.assertIn(words, faults[0])

    def test_the_repository_has_no_fault(self):
        self.assertEqual(release.faults_of(ROOT), [])

    def test_a_different_version_is_detected_everywhere(self):
        for name, pattern in release.PLACES[1:]:
            with self.subTest(name=name):
                text = (self.root / name).read_text()
                (self.root / name).write_text(re.sub(pattern, lambda m: m.group(0).replace(
                    m.group(1), "9.9.9" if release.FULL in m.re.pattern else "9.9"), text))
                self.one_fault(f"{name} has 9.9")
                (self.root / name).write_text("nothing\n")
                self.assertTrue(any("no version matches" in fault for fault in release.faults_of(self.root)))
                (self.root / name).write_text(text)

    def test_pythons_source_package_has_the_files_of_the_build(self):
        rules = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["scikit-build"]["sdist"]
        read = set()
        for name in ("CMakeLists.txt", "*/CMakeLists.txt", "tools/*/CMakeLists.txt", "cmake/*.cmake"):
            for path in ROOT.glob(name):
                if f"/{path.relative_to(ROOT).parts[0]}" not in rules["exclude"]:
                    read |= set(re.findall(r"PROJECT_SOURCE_DIR\}(/[\w./-]+)", path.read_text()))
        self.assertIn("/docs/reference/scene_format.md", read)
        left_out = [path for path in sorted(read)
                    if path not in rules["include"] and "/" + path.split("/")[1] in rules["exclude"]]
        self.assertEqual(left_out, [])

    def test_the_changelog_keeps_its_form(self):
        self.change("CHANGELOG.md", "### Added", "### News")
        self.one_fault("### News: expected one of")

    def test_headings_are_unique(self):
        self.change("CHANGELOG.md", "(?s)(### Changed.*?)### Fixed", r"\1### Changed")
        self.one_fault("has ### Changed twice")

    def test_an_entry_has_a_heading(self):
        self.change("CHANGELOG.md", "(?m)^## \\[Unreleased\\]$", "## [Unreleased]\n\n* Lost.")
        self.one_fault("an entry is above the first heading")

    def test_a_group_begins_a_paragraph(self):
        self.change("CHANGELOG.md", r"\n\n(For programmers)\n", r"\n\1\n")
        self.one_fault("For programmers: an empty line is missing above")

    def test_the_mark_of_bits_has_one_form(self):
        self.change("CHANGELOG.md", r"\*\*\(changes bits\)\*\*( The contact of two)", r"(changes bits\1)")
        self.one_fault("expected **(changes bits)**")

    def test_removing_a_declaration_is_a_fault_and_adding_one_is_not(self):
        self.change("capi/include/carom/carom.h", r"CAROM_API double carom_record_duration",
                    "CAROM_API int carom_new(void);\nCAROM_API double carom_record_duration")
        self.assertEqual(release.faults_of(self.root), [])
        self.change("capi/include/carom/carom.h", r"double restitution;", "float restitution;")
        self.one_fault("no longer declares")

    def test_removing_an_npm_type_is_a_fault_and_adding_one_is_not(self):
        self.change("web/npm/index.d.ts", "(export interface Cue {\n)", r"\1  chalk: number; // new\n")
        self.assertEqual(release.faults_of(self.root), [])
        # Other interfaces still have the same line.
        self.change("web/npm/index.d.ts", r"(?s)(export interface BallPlace \{.*?)  x: number;\n", r"\1")
        self.one_fault("index.d.ts no longer declares")

    def test_a_new_option_of_a_rule_is_no_fault_but_a_new_default_is(self):
        self.change("games/src/eight_ball.cpp", r'\{"fair", "foul"\}', '{"fair", "foul", "rerack"}')
        self.assertEqual(release.faults_of(self.root), [])
        self.change("games/src/eight_ball.cpp", r'\{"all", "eight", "none"\}', '{"eight", "all", "none"}')
        self.assertTrue(any("EightBall: call = all (default)" in f for f in release.faults_of(self.root)))

    def test_removing_npms_program_is_a_fault(self):
        self.change("web/npm/package.json", r'"bin": \{"carom"', '"bin": {"billiards"')
        self.one_fault("npx carom")

    def test_a_comment_is_not_a_declaration(self):
        self.change("capi/include/carom/carom.h", r"/\* of the cue \[m/s\] \*/", "/* quite another; word */")
        self.assertEqual(release.faults_of(self.root), [])

    def test_changed_bits_are_a_fault(self):
        self.change("tests/data/engine/golden_hashes.json", r'("draw": ")[0-9a-f]{4}', r"\g<1>0000")
        self.one_fault('the bits of "draw" changed')

    def test_a_changed_record_version_is_a_fault(self):
        self.change("docs/reference/record.schema.json", r'("version":\s*\{[^}]*"const":\s*)4', r"\g<1>5")
        self.one_fault("records have version 5 instead of 4")

    def test_a_cut_release_has_no_fault(self):
        date = datetime.datetime(2030, 1, 2, 3, 4, 5, tzinfo=datetime.timezone.utc)
        major, minor, patch = map(int, release.version_here(self.root).split("."))
        for version in (f"{major}.{minor}.{patch + 1}", f"{major}.{minor + 1}.0", f"{major + 1}.0.0"):
            with self.subTest(version=version):
                self.change("CHANGELOG.md", r"(?s)## \[Unreleased\]\n.*?(?=\n## |\Z)",
                            "## [Unreleased]\n\n### Added\n\n* New in " + version + ".\n")
                release.set_version(self.root, version, date)
                self.assertEqual(release.faults_of(self.root), [])
                self.assertEqual(release.version_here(self.root), version)
                self.assertIn(f"## [{version}] - 2030-01-02", (self.root / "CHANGELOG.md").read_text())
                self.assertEqual(
                    (self.root / "CITATION.cff").read_text().count("date-released: 2030-01-02"), 1)
                self.assertIn(f"* New in {version}.", release.notes(self.root))

    def test_promises_of_the_next_minor_version_forbid_a_patch(self):
        major, minor, patch = release.number(release.version_here(self.root))
        release.write_promise(self.root, f"{major}.{minor + 1}")
        self.assertEqual(release.faults_of(self.root), [])
        release.refuse_broken_promise(self.root, f"{major}.{minor + 1}.0")
        with self.assertRaisesRegex(SystemExit, f"choose {major}.{minor + 1}.0 or later"):
            release.refuse_broken_promise(self.root, f"{major}.{minor}.{patch + 1}")

    def test_a_patch_may_not_renew_a_promise(self):
        self.change("capi/include/carom/carom.h", r"double restitution;", "float restitution;")
        major, minor, patch = map(int, release.version_here(self.root).split("."))
        release.set_version(self.root, f"{major}.{minor}.{patch + 1}",
                            datetime.datetime(2030, 1, 2, tzinfo=datetime.timezone.utc))
        self.one_fault("no longer declares")

    @unittest.skipUnless(shutil.which("git"), "git is not installed")
    def test_cutting_commits_and_tags_only_on_success(self):
        def git(*words):
            return subprocess.run(["git", "-C", self.root, *words], check=True, text=True,
                                  stdout=subprocess.PIPE).stdout.strip()

        def files(root, out, skip, jobs):
            out.mkdir(parents=True)
            (out / f"carom-{release.version_here(root)}-notes.md").write_text(release.notes(root))
            self.assertEqual(skip, ())
            if fails:
                release.fail("two builds differ")

        git("init", "--quiet", "--initial-branch=main")
        git("config", "user.name", "somebody")
        git("config", "user.email", "somebody@example.org")
        (self.root / ".gitignore").write_text("/build/\n")
        # Right after a release the section is empty.
        self.change("CHANGELOG.md", r"(?s)## \[Unreleased\]\n.*?(?=\n## |\Z)",
                    "## [Unreleased]\n\n### Added\n\n* Something.\n")
        git("add", "--all")
        git("commit", "--quiet", "-m", "start")
        start = git("rev-parse", "HEAD")
        major, minor, _ = release.version_here(self.root).split(".")
        version = f"{major}.{int(minor) + 1}.0"
        with unittest.mock.patch.object(release, "ROOT", self.root), unittest.mock.patch.object(
            release, "make_files", files
        ), \
                unittest.mock.patch.object(
                    release, "sections", lambda root=self.root, sections=release.sections: sections(root)), \
                unittest.mock.patch.object(
                    release, "version_here", lambda root=self.root, here=release.version_here: here(root)), \
                contextlib.redirect_stderr(io.StringIO()):
            fails = True
            with self.assertRaisesRegex(SystemExit, "two builds differ"):
                release.cut(version, 1)
            self.assertEqual((git("rev-parse", "HEAD"), git("tag")), (start, ""))
            shutil.rmtree(self.root / "build")
            fails = False
            release.cut(version, 1)
            self.assertEqual(git("tag"), f"v{version}")
            self.assertEqual(git("rev-parse", f"v{version}^{{commit}}~1"), start)
            self.assertEqual(git("status", "--porcelain"), "")
            self.assertIn(f"carom [{version}]", git("tag", "-n1"))
            with self.assertRaisesRegex(SystemExit, "is not later than"):
                release.cut(version, 1)
            (self.root / "CHANGELOG.md").write_text((self.root / "CHANGELOG.md").read_text() + "\n")
            with self.assertRaisesRegex(SystemExit, "uncommitted changes"):
                release.cut(f"{major}.{int(minor) + 2}.0", 1)


if __name__ == "__main__":
    unittest.main()
