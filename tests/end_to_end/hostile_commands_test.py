"""Commands that were given something hostile: each fails with one line and leaves the site as it was, or does what it was
asked to do without a trace elsewhere. Usage: hostile_commands_test.py MADORI DATA"""

import fcntl
import hashlib
import json
import os
import pathlib
import shutil
import signal
import sqlite3
import stat
import subprocess
import sys
import tarfile
import tempfile
import time
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

    def test_a_result_that_cannot_be_written_is_said_before_the_log_is_read(self):
        before, drawing, nowhere = state(self.site), DATA / "sample_factory" / "factory.dxf", self.here / "none" / "way.tum"
        localize = ("localize", self.site, "--log", drawing, "--initial", "0 0 0", "--learn", "--memory")
        good = ("--out", self.here / "way.tum")
        for command in ((*localize, "--out", nowhere), *((*localize, *good, option, nowhere) for option in
                                                         ("--plot", "--health", "--on-drawing", "--walls-plot", "--json")),
                        ("relocalize", self.site, "--log", drawing, "--out", nowhere),
                        *(("map", "--log", drawing, "--out", self.here / "made", option, nowhere) for option in
                          ("--trajectory", "--final", "--plot"))):
            self.refused(madori(*command), str(nowhere))
            self.assertEqual(state(self.site), before, command)
            self.assertFalse((self.here / "made").exists() or (self.here / "way.tum").exists(), command)

    def test_what_a_program_drives_by_is_not_changed_under_it(self):
        drawing, backup = DATA / "sample_factory" / "factory.dxf", self.here / "site.tar"
        self.assertEqual(madori("export", self.site, "--backup", backup).returncode, 0)
        changes = (("scale", self.site, "--known=10,10,300,10=15", "--apply", "--force"), ("diff", self.site, drawing, "--apply"),
                   ("versions", self.site, "--restore", 1), ("import", drawing, "--site", self.site, "--force"),
                   ("import", backup, "--site", self.site, "--force"), ("map", "--log", drawing, "--out", self.site, "--force"),
                   ("localize", self.site, "--log", drawing, "--initial", "0 0 0", "--out", self.here / "way.tum", "--learn"))
        before = state(self.site)
        with open(self.site / ".run.lock", "w") as lock:  # as a program that drives holds it
            fcntl.flock(lock, fcntl.LOCK_EX)
            lock.write("4711")
            lock.flush()
            for change in changes:
                self.refused(madori(*change), "a program drives the vehicle of this site (process 4711)", "panel")
                self.assertEqual(state(self.site), before, change)
            self.assertEqual(madori("scale", self.site, "--known=10,10,300,10=15").returncode, 0)  # a look changes nothing
        self.assertEqual(madori("versions", self.site, "--restore", 1).returncode, 0)  # and it goes when the program has ended

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

    def test_an_order_that_was_delivered_is_not_said_to_be_cancelled(self):
        for _ in range(2):
            self.assertEqual(madori("order", self.site, "--to", "13").returncode, 0)
        with sqlite3.connect(self.site / "madori.db") as database:
            database.execute("UPDATE orders SET state = 'done' WHERE id = 1")
        database.close()
        self.refused(madori("order", self.site, "--cancel", 1), "order 1", "done")
        self.refused(madori("order", self.site, "--to", "13", "--cancel", 9), "no order 9")
        self.assertEqual(madori("order", self.site, "--cancel", 2).returncode, 0)
        self.assertEqual(madori("order", self.site, "--cancel", 2).returncode, 0)  # what was asked for is so
        self.assertEqual(madori("order", self.site).stdout, "")  # a refused call has queued nothing
        (self.site / "madori.db").unlink()

    def test_json_on_the_standard_output_is_json_alone(self):
        scenario = self.here / "empty.yaml"
        shutil.copy(DATA / "scenarios" / "empty.yaml", scenario)
        for words in (("route", self.site, "--check"), ("versions", self.site), ("order", self.site), ("scale", self.site, "--known=10,10,300,10=15"),
                      ("sim", self.site, "--scenario", scenario, "--duration", 0.1, "--lidar-port", 9, "--camera-port", 0)):
            answer = madori(*words, "--json", "-")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            json.loads(answer.stdout)
        (self.site / "madori.db").unlink()

    def test_an_order_whose_answer_nobody_reads_is_said_to_be_queued(self):
        reader, writer = os.pipe()
        os.close(reader)
        answer = subprocess.run([MADORI, "order", self.site, "--to", "13", "--json", "-"], stdout=writer,
                                stderr=subprocess.PIPE, text=True, timeout=60)
        os.close(writer)
        self.assertEqual(answer.returncode, 1, answer.stderr)
        self.assertIn("is queued, but standard output", answer.stderr)
        (self.site / "madori.db").unlink()

    def test_a_word_that_is_no_command_is_named(self):
        answer = madori("nosuch", self.site)
        self.assertEqual(answer.returncode, 2)
        self.assertEqual(answer.stderr, "madori: nosuch: is no command - madori --help lists them\n")
        self.assertIn("subcommand", madori().stderr)

    def test_an_option_that_does_nothing_with_the_file_is_refused_and_nothing_is_made(self):
        png = next((DATA / "sample_factory").glob("*.png"))
        for words in (["--page", "2"], ["--unit", "mm"], ["--layers", "A"]):
            self.refused(madori("import", png, "--site", self.here / "made", *words), words[0], png.name)
        backup = self.here / "backup.tar"
        with tarfile.open(backup, "w", format=tarfile.USTAR_FORMAT) as tar:
            tar.add(self.site / "site.yaml", "site/site.yaml")
        self.refused(madori("import", backup, "--site", self.here / "made", "--scale", "0.05"), "--scale", "backup")
        self.assertFalse((self.here / "made").exists())

    def test_a_service_is_installed_with_options_of_run_alone(self):
        self.refused(madori("service", "install", self.site, "--user", "root", "--print", "--", "--bogus"), "--bogus")
        good = madori("service", "install", self.site, "--user", "root", "--print", "--", "--hmi", "0.0.0.0:8080")
        self.assertEqual(good.returncode, 0, good.stderr)
        self.assertIn('"0.0.0.0:8080"', good.stdout)

    @unittest.skipIf(os.geteuid() != 0, "it becomes another user")
    def test_what_the_system_refuses_is_said_with_its_file_and_a_remedy(self):
        site = pathlib.Path(tempfile.mkdtemp(dir="/tmp"))
        try:
            shutil.copytree(self.site, site, dirs_exist_ok=True)
            nobody = lambda *words: madori(*words, user=65534, group=65534, extra_groups=[], cwd="/")
            site.chmod(0o755)  # not its owner: it reads, and writes nothing
            self.refused(nobody("sim", site, "--duration", "1"), "devices", "Permission denied", " - ")
            (site / "routes").chmod(0o700)
            answer = nobody("route", site, "--check")
            self.refused(answer, "routes", "Permission denied", " - ")
            self.assertNotIn("draw routes", answer.stderr)
            (site / "walls.csv").chmod(0o600)
            self.assertNotIn("import", nobody("scale", site, "--self-calibration").stderr)
            site.chmod(0o700)
            for words in (["route", site, "--check"], ["sim", site], ["versions", site], ["doctor", site]):
                answer = nobody(*words)
                self.assertNotIn("filesystem error", answer.stderr, words)
                self.assertIn(" - ", answer.stderr, words)
        finally:
            shutil.rmtree(site)

    def test_a_log_without_a_scan_is_refused_and_nothing_is_written(self):
        log, out = self.here / "wheels.log", self.here / "poses.txt"
        log.write_text("ODOM 0 0 0 0 0 0 1 host 1\nODOM 0.1 0 0 0 0 0 2 host 2\n")
        for command in (("relocalize", self.site), ("localize", self.site, "--global")):
            self.refused(madori(*command, "--log", log, "--out", out), "holds no scan")
            self.assertFalse(out.exists())

    def spoiled(self, name, content):
        """A copy of the site with one file replaced; `content` None: a folder in its place."""
        copy = pathlib.Path(tempfile.mkdtemp(dir=self.here)) / "site"
        shutil.copytree(self.site, copy)
        (copy / name).unlink()
        if content is None:
            (copy / name).mkdir()
        else:
            (copy / name).write_bytes(content)
        return copy

    def test_spoiled_files_of_a_site_are_refused_in_one_line(self):
        yaml, path = (self.site / "site.yaml").read_bytes(), (self.site / "routes/path.csv").read_bytes()
        sensor = b"  - {name: a, type: vlp16}\n"
        for name, content, *words in (
                ("walls.csv", b"", "walls.csv", "empty"), ("walls.csv", b"id,x1,y1,x2,y2\n", "no wall"),
                ("walls.csv", b"id,x1,y1,x2,y2\n" + b"1" * 20_000_000, "longer than"),
                ("site.yaml", yaml + b"name: again\n", "stands twice"), ("site.yaml", None, "folder"),
                ("site.yaml", yaml.split(b"sensors:")[0] + b"sensors:\n" + sensor * 200_000, "bytes, more than"),
                ("walls.csv", None, "folder"), ("routes/path.csv", None, "folder")):
            begun = time.monotonic()
            self.refused(madori("route", self.spoiled(name, content), "--check"), *words)
            self.assertLess(time.monotonic() - begun, 20)
        for content, word in ((path.decode().encode("utf-16"), "UTF-8"),
                              (path.replace(b"\n0,", b'\n0,"', 1) if b"\n0," in path else path + b'99,"1,2\n', "quote")):
            answer = madori("route", self.spoiled("routes/path.csv", content), "--check")
            self.assertEqual(answer.returncode, 1)
            self.assertIn(word, answer.stderr)
            self.assertLessEqual(len(answer.stderr.splitlines()), 22)

    def test_a_pipe_in_place_of_a_file_does_not_hang(self):
        copy = self.spoiled("site.yaml", b"")
        (copy / "site.yaml").unlink()
        os.mkfifo(copy / "site.yaml")
        self.refused(madori("route", copy, "--check"), "no regular file")

    def test_a_stop_without_its_seconds_is_refused(self):
        for stop in ("13:wait=", "13:wait=x", "13:wait=nan", "13:wait=-1"):
            self.refused(madori("order", self.site, "--to", stop), "is no stop")

    def has_the_site(self, run):
        """Waits until a run says that the site is its own; from then on it ends in order."""
        lock = self.site / ".run.lock"
        while not lock.exists() or str(run.pid) not in lock.read_text():
            self.assertIsNone(run.poll())
            time.sleep(0.01)

    def test_a_second_run_on_one_site_is_refused(self):
        run = ["run", self.site, "--hmi", "off", "--no-record", "--lidar", "127.0.0.1", "--lidar-port", "0",
               "--position-port", "0", "--drive", self.here / "no-drive"]
        first = subprocess.Popen([MADORI, *map(str, run)], stdout=subprocess.PIPE, text=True)
        try:
            first.stdout.readline()
            self.has_the_site(first)
            self.refused(madori(*run), "another program", str(first.pid))
        finally:
            first.send_signal(signal.SIGKILL)
            first.wait()
        again = subprocess.Popen([MADORI, *map(str, run)], stdout=subprocess.DEVNULL)
        try:  # what was killed holds nothing
            self.has_the_site(again)
            with self.assertRaises(subprocess.TimeoutExpired):
                again.wait(2)
        finally:
            again.send_signal(signal.SIGTERM)
            self.assertEqual(again.wait(30), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
