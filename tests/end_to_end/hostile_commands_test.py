"""Commands that were given something hostile: each fails with one line and leaves the site as it was, or does what it was
asked to do without a trace elsewhere. Usage: hostile_commands_test.py MADORI DATA"""

import hashlib
import os
import pathlib
import signal
import stat
import subprocess
import sys
import tempfile
import unittest

from sample_site import make_site

MADORI, DATA = sys.argv[1], pathlib.Path(sys.argv[2])


def madori(*words, **more):
    return subprocess.run([MADORI, *map(str, words)], capture_output=True, text=True, timeout=120, **more)


def state(folder):
    """Names and contents of a folder."""
    return {str(f.relative_to(folder)): hashlib.sha256(f.read_bytes()).hexdigest()
            for f in sorted(folder.rglob("*")) if f.is_file() and ".lock" not in f.name}


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.here = pathlib.Path(cls.folder.name)
        cls.site = cls.here / "site"
        make_site(MADORI, DATA, cls.site, quiet=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def refused(self, answer, *words):
        self.assertEqual(answer.returncode, 1, answer.stdout + answer.stderr)
        lines = [line for line in answer.stderr.splitlines() if line]
        self.assertEqual(len(lines), 1, answer.stderr)
        for word in words:
            self.assertIn(word, lines[0])

    def test_a_scale_that_no_building_has_is_refused_and_nothing_changes(self):
        before = state(self.site)
        for known in ("10,10,300,10=1e-300", "10,10,300,10=1.6e-7", "10,10,300,10=1e9", "10,10,1000000,10=5",
                      "-5000,10,300,10=5"):
            for force in ([], ["--force"]):
                answer = madori("scale", self.site, f"--known={known}", "--apply", *force)
                self.assertEqual(answer.returncode, 1, f"{known}: {answer.stdout}")
                self.assertEqual(state(self.site), before, known)
        self.assertEqual(madori("route", self.site, "--check").returncode, 0)

    def test_devices_pipes_and_links_are_written_into(self):
        subject = ("route", self.site, "--from", 13, "--to", 15)
        for option in ("--json", "--out"):
            self.assertEqual(madori(*subject, option, "/dev/null").returncode, 0)
            self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
            self.refused(madori(*subject, option, "/dev/full"), "/dev/full")
            target, link = self.here / "target", self.here / "link"
            link.unlink(missing_ok=True)
            link.symlink_to(target)
            self.assertEqual(madori(*subject, option, link).returncode, 0)
            self.assertTrue(link.is_symlink() and target.stat().st_size > 0)

    def test_a_full_standard_output_is_a_failure(self):
        for words in (("route", self.site, "--from", 13, "--to", 15, "--json", "-"), ("route", self.site, "--check"),
                      ("version",), ("--help",)):
            with open("/dev/full", "w") as full:
                answer = subprocess.run([MADORI, *map(str, words)], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(answer.returncode, 1, words)
            self.assertIn("standard output", answer.stderr)

    def test_a_second_run_on_one_site_is_refused(self):
        run = ["run", self.site, "--hmi", "off", "--no-record", "--lidar", "127.0.0.1", "--lidar-port", "0",
               "--position-port", "0", "--drive", self.here / "no-drive"]
        first = subprocess.Popen([MADORI, *map(str, run)], stdout=subprocess.PIPE, text=True)
        try:
            first.stdout.readline()
            while not (self.site / ".run.lock").exists() or not (self.site / ".run.lock").read_text():
                self.assertIsNone(first.poll())
            self.refused(madori(*run), "another program", str(first.pid))
        finally:
            first.send_signal(signal.SIGKILL)
            first.wait()
        again = subprocess.Popen([MADORI, *map(str, run)], stdout=subprocess.DEVNULL)
        try:  # what was killed holds nothing
            with self.assertRaises(subprocess.TimeoutExpired):
                again.wait(2)
        finally:
            again.send_signal(signal.SIGTERM)
            self.assertEqual(again.wait(30), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
