"""Progress and cancellation: from on_progress, from another thread, by Ctrl-C; and other threads run meanwhile."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import focal
from support import Case, detection, mesh, model, training_set

Status = focal.Status
SLOW = {"tree_count": 300}  # some seconds on these shapes


class Told(Case):
    def test_progress_of_every_long_call(self):
        surface, found = mesh(), detection()
        calls = {
            "train": lambda tell: focal.Model.train(training_set(), on_progress=tell),
            "detect": lambda tell: model().detect(surface, on_progress=tell),
            "analyse": lambda tell: model().analyse(surface, on_progress=tell),
            "segment": lambda tell: found.segment("k_means", on_progress=tell),
            "correspond": lambda tell: found.correspond(found, on_progress=tell),
        }
        for name, long_call in calls.items():
            told = []
            self.assertIsNotNone(long_call(lambda *state: told.append((*state, threading.current_thread()))))
            progress = [state[0] for state in told]
            self.assertEqual(progress, sorted(progress), name)
            self.assertTrue(0 <= progress[0] and progress[-1] == 1, name)
            self.assertTrue(all(isinstance(state[1], str) for state in told), name)
            self.assertEqual({state[2] for state in told}, {threading.current_thread()}, name)
            if name == "train":
                self.assertGreater(len({state[1] for state in told}), 1)

    def test_what_it_raises_cancels_and_is_raised(self):
        class Enough(Exception):
            pass

        def stop(progress, stage):
            raise Enough(stage)

        task, began = focal.Task(), time.monotonic()
        with self.assertRaises(Enough):
            focal.Model.train(training_set(), task=task, on_progress=stop, **SLOW)
        self.assertLess(time.monotonic() - began, 2)
        self.assertTrue(task.cancelled)
        with self.assertRaises(Enough):  # also when the work is done by then
            detection().segment("geodesic", on_progress=stop)

    def test_errors_come_through(self):
        for tell in (None, lambda progress, stage: None):
            with self.assertRaises(focal.Error) as caught:
                focal.Model.train(training_set(), tree_count=0, on_progress=tell)
            self.assertIs(caught.exception.code, Status.INVALID_ARGUMENT)


class Cancelled(Case):
    def cancelled_train(self, task, **named):
        with self.assertRaises(focal.Cancelled) as caught:
            focal.Model.train(training_set(), task=task, **SLOW, **named)
        self.assertIs(caught.exception.code, Status.CANCELLED)
        return time.monotonic()

    def test_from_another_thread(self):
        for named in ({}, {"on_progress": lambda progress, stage: None}):
            task, at = focal.Task(), []

            def press_escape():
                while task.progress < 0.05:
                    time.sleep(0.005)
                at.append(time.monotonic())
                task.cancel()

            thread = threading.Thread(target=press_escape)
            thread.start()
            returned = self.cancelled_train(task, **named)
            thread.join()
            self.assertLess(returned - at[0], 1)  # 0.1 s, on a machine with nothing else to do
            self.assertTrue(task.cancelled and task.stage and 0 < task.progress < 1)

    def test_a_call_off_the_main_thread(self):
        task, caught = focal.Task(), []

        def work():
            try:
                focal.Model.train(training_set(), task=task, **SLOW)
            except focal.Cancelled as error:
                caught.append(error)

        thread = threading.Thread(target=work)
        thread.start()
        while task.progress < 0.05:
            time.sleep(0.005)
        task.cancel()
        thread.join()
        self.assertEqual(len(caught), 1)

    def test_before_the_call_and_until_reset(self):
        task = focal.Task()
        self.assertEqual((task.progress, task.stage, task.cancelled), (0, "", False))
        task.cancel()
        self.cancelled_train(task)
        self.cancelled_train(task)
        task.reset()
        self.assertEqual((task.progress, task.cancelled), (0, False))
        self.assertEqual(len(model().detect(mesh(), task=task)), 3)
        self.assertGreater(task.progress, 0.99)

    def test_one_task_serves_one_call(self):
        task, refused = focal.Task(), []

        def second():
            while not task.stage:
                time.sleep(0.005)
            for use in (lambda: model().detect(mesh(), task=task), task.reset):
                try:
                    use()
                except focal.Error as error:
                    refused.append(error)
            task.cancel()

        model()
        thread = threading.Thread(target=second)
        thread.start()
        self.cancelled_train(task)
        thread.join()
        self.assertEqual([error.code for error in refused], [Status.INVALID_ARGUMENT] * 2)
        self.assertIn("in use", refused[0].message)

    def test_a_set_is_not_changed_while_it_teaches(self):
        task, marked = focal.Task(), training_set()

        def work():
            with self.assertRaises(focal.Cancelled):
                focal.Model.train(marked, task=task, **SLOW)

        thread = threading.Thread(target=work)
        thread.start()
        while task.progress < 0.05:
            time.sleep(0.005)
        with self.assertRaisesRegex(RuntimeError, "being trained"):
            marked.add(mesh(), [0, 1, 2])
        task.cancel()
        thread.join()
        marked.add(mesh(), [0, 1, 2])
        self.assertEqual(marked.mesh_count, 5)


class Python(Case):
    def test_other_threads_run_meanwhile(self):
        for on_main in (True, False):
            ticks, done = 0, threading.Event()

            def train():
                focal.Model.train(training_set(), tree_count=30, learn_confidence=False)
                done.set()

            def count():
                nonlocal ticks
                while not done.is_set():
                    ticks += 1
                    time.sleep(0.01)

            other = threading.Thread(target=count if on_main else train)
            other.start()
            (train if on_main else count)()
            other.join()
            self.assertGreater(ticks, 5)

    @unittest.skipIf(sys.platform == "win32", "signals of POSIX")
    def test_ctrl_c(self):
        code = ("import focal, support\n"
                "def tell(progress, stage): print(stage, flush=True)\n"
                "try: focal.Model.train(support.training_set(), tree_count=2000, on_progress=%s)\n"
                "except KeyboardInterrupt: print('interrupted', flush=True)\n")
        for tell in ("tell", "None"):
            with subprocess.Popen([sys.executable, "-c", "print('begun', flush=True)\n" + code % tell],
                                  stdout=subprocess.PIPE, text=True, cwd=os.path.dirname(os.path.abspath(__file__)),
                                  env=dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))) as process:
                process.stdout.readline()
                time.sleep(1)
                began = time.monotonic()
                process.send_signal(signal.SIGINT)
                said, _ = process.communicate(timeout=60)
                self.assertTrue(said.endswith("interrupted\n"), said)
                self.assertEqual(process.returncode, 0)
                self.assertLess(time.monotonic() - began, 2)


if __name__ == "__main__":
    unittest.main()
