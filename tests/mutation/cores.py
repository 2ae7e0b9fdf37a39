# SPDX-License-Identifier: Apache-2.0
"""The cores of the machine, each doing one thing at a time; of what waits, what belongs to the line broken first."""
import concurrent.futures
import itertools
import queue
import threading


class Cores:
    def __init__(self, cores):
        # Two each, of which the neighbour has one as well: a test of threads has more than one.
        self.sets = [{core, cores[(k + 1) % len(cores)]} for k, core in enumerate(cores)]
        self.waiting = queue.PriorityQueue()
        self.order = itertools.count()
        for own in self.sets:
            threading.Thread(target=self._serve, args=(own,), daemon=True).start()

    def __len__(self):
        return len(self.sets)

    def submit(self, rank, work, *arguments):
        """A future of `work(*arguments, cores)`; the smallest rank goes first."""
        future = concurrent.futures.Future()
        self.waiting.put((rank, next(self.order), future, work, arguments))
        return future

    def _serve(self, own):
        while True:
            _, _, future, work, arguments = self.waiting.get()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(work(*arguments, own))
            except BaseException as failure:  # noqa: BLE001, which is raised again by who asks for the result
                future.set_exception(failure)
