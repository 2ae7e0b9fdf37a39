# SPDX-License-Identifier: Apache-2.0
import threading
import unittest

from cores import Cores


class OneCore(unittest.TestCase):
    def test_takes_the_smallest_rank_first_and_what_came_first_of_one(self):
        cores, begin, order = Cores([0]), threading.Event(), []
        cores.submit(0, lambda own: begin.wait())
        futures = [cores.submit(rank, lambda name, own: order.append(name), name)
                   for rank, name in ((3, "c"), (1, "a"), (2, "b"), (1, "aa"))]  # fmt: skip
        dropped = cores.submit(0, lambda own: order.append("dropped"))
        self.assertTrue(dropped.cancel())
        begin.set()
        for future in futures:
            future.result()
        self.assertEqual(order, ["a", "aa", "b", "c"])

    def test_hands_on_results_and_failures(self):
        cores = Cores([0, 1, 2])
        self.assertEqual(cores.submit(1, lambda a, own: (a, own), 5).result()[0], 5)
        with self.assertRaises(ZeroDivisionError):
            cores.submit(1, lambda own: 1 / 0).result()
        self.assertEqual([len(own) for own in cores.sets], [2, 2, 2])


if __name__ == "__main__":
    unittest.main()
