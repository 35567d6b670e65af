"""Eight threads at once: the same objects, objects of their own, and objects that are closed under them."""
import gc
import threading
import unittest

import focal
from support import NAMES, Case, detection, mesh, model, rows, shape

THREADS = 8


def at_once(work):
    """work(number) on eight threads that start together; gives results and exceptions in order."""
    gate, outcomes = threading.Barrier(THREADS), [None] * THREADS

    def run(number):
        gate.wait()
        try:
            outcomes[number] = work(number)
        except Exception as error:
            outcomes[number] = error

    threads = [threading.Thread(target=run, args=(number,)) for number in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return outcomes


class Shared(Case):
    def test_one_model_and_mesh(self):
        surface, expected = mesh(), detection().landmarks
        for outcome in at_once(lambda number: [model().detect(surface).landmarks for _ in range(2)]):
            self.assertEqual(outcome, [expected] * 2)

    def test_one_detection(self):
        found = detection()
        expected = (found.landmarks, list(found.votes(1)), list(found.distances(2)), list(found.segment()))
        for outcome in at_once(lambda number: (found.landmarks, list(found.votes(1)), list(found.distances(2)),
                                               list(found.segment()))):
            self.assertEqual(outcome, expected)

    def test_one_training_set_is_filled_in_turn(self):
        marked = focal.TrainingSet(NAMES)
        at_once(lambda number: [marked.add(mesh(16, 0.01 * number), shape(16, 0.01 * number)[2]) for _ in range(10)])
        self.assertEqual(marked.mesh_count, 10 * THREADS)


class Own(Case):
    def test_whole_lives(self):
        def life(number):
            context = focal.Context(thread_count=1)
            marked = focal.TrainingSet(NAMES, context=context)
            for variation in (0, 0.1):
                vertices, faces, marks = shape(16, variation)
                marked.add(focal.Mesh(vertices, faces, context=context), marks)
            made = focal.Model.train(marked, tree_count=2, learn_confidence=False)
            return focal.Model.from_bytes(made.to_bytes()).detect(mesh()).landmarks

        outcomes = at_once(life)
        self.assertEqual(outcomes, [outcomes[0]] * THREADS)
        self.assertEqual(len(outcomes[0]), 3)

    def test_errors_stay_with_their_thread(self):
        def fail(number):
            return [self.refused(focal.Status.FILE_NOT_FOUND, f"nowhere {number}.glb", focal.Mesh.load,
                                 f"nowhere {number}.glb") for _ in range(200)]

        for outcome in at_once(fail):
            self.assertIsInstance(outcome, list, outcome)


class Closed(Case):
    def test_closing_under_a_reader(self):
        expected = rows(mesh().vertices)
        for _ in range(20):
            surface = mesh()

            def read(number):
                if number == 0:
                    return surface.close()
                for _ in range(20):
                    if rows(surface.vertices) != expected:
                        return "torn"
                return None

            for outcome in at_once(read):
                if outcome is not None:
                    self.assertIs(getattr(outcome, "code", outcome), focal.Status.INVALID_HANDLE)

    def test_closing_under_a_call(self):
        for _ in range(2):
            surface = mesh()
            outcomes = at_once(lambda number: surface.close() if number == 0 else model().detect(surface).landmarks)
            for outcome in outcomes[1:]:
                if isinstance(outcome, focal.Error):
                    self.assertIs(outcome.code, focal.Status.INVALID_HANDLE)
                else:
                    self.assertEqual(outcome, detection().landmarks)

    def test_the_collector_beside_calls(self):
        def litter(number):
            for _ in range(30):
                ring = [mesh()]
                ring.append(ring)
                gc.collect()
            return number

        self.assertEqual(at_once(litter), list(range(THREADS)))


if __name__ == "__main__":
    unittest.main()
