# SPDX-License-Identifier: MIT
"""Progress bars of tqdm for long calls."""

from __future__ import annotations

import threading
from contextlib import nullcontext

_MOST_STEPS = 100
_SECONDS = 0.1  # from one look to the next


class _NoBar:
    @staticmethod
    def update(count):
        pass


def _bar(total, name):
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("progress: requires tqdm, which is not installed") from None
    return tqdm(total=total, desc=name, leave=False)


def in_blocks(count, least, name, work):
    """Call work(first, last) for blocks of at least `least` of `count` items. Without a name there is no bar."""
    step = max(least, -(-count // _MOST_STEPS))
    with nullcontext(_NoBar) if name is None else _bar(count, name) as bar:
        for first in range(0, count, step):
            work(first, min(first + step, count))
            bar.update(min(step, count - first))


def watched(scene, name, work):
    """Return the result of work() while another thread counts its rows. Only this thread receives Ctrl-C."""
    has_ended = threading.Event()

    def count(bar):
        while not has_ended.wait(_SECONDS):
            done, bar.total = scene._core.progress()
            bar.update(done - bar.n)

    with _bar(None, name) as bar:
        counting = threading.Thread(target=count, args=(bar,))
        counting.start()
        try:
            return work()
        finally:
            has_ended.set()
            counting.join()
