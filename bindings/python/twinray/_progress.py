# SPDX-License-Identifier: MIT
"""Bars of tqdm's for what takes long."""

from __future__ import annotations

_MOST_STEPS = 100
_SECONDS = 0.1  # from one look to the next


def _bar(total, name):
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("progress: needs tqdm, which is not installed") from None
    return tqdm(total=total, desc=name, leave=False)


def in_blocks(count, least, name, work):
    """Calls work(first, last) for blocks of at least so many of `count` things."""
    step = max(least, -(-count // _MOST_STEPS))
    with _bar(count, name) as bar:
        for first in range(0, count, step):
            work(first, min(first + step, count))
            bar.update(min(step, count - first))


def watched(scene, name, work):
    """The result of work(), which another thread does, while its rows are counted here."""
    from concurrent.futures import ThreadPoolExecutor, TimeoutError  # takes a third of `import twinray`

    with _bar(None, name) as bar, ThreadPoolExecutor(1) as pool:
        future = pool.submit(work)
        while True:
            try:
                return future.result(_SECONDS)
            except TimeoutError:
                done, bar.total = scene._core.progress()
                bar.update(done - bar.n)
