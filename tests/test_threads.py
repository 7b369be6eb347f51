"""Work that threads share: its order, and its progress bars."""

import tqdm.auto

from lube.threads import on_threads, progress_bars


def test_results_are_in_the_order_of_the_items_whatever_the_threads():
    items = iter(range(50))
    assert on_threads(lambda one: one**2, items, threads=3) == [one**2 for one in range(50)]


def test_only_named_work_within_progress_bars_has_a_bar(monkeypatch):
    shown = []

    def bar(found, name, **options):
        shown.append((name, options["total"]))
        return found

    monkeypatch.setattr(tqdm.auto, "tqdm", bar)
    on_threads(abs, range(3), name="before")
    with progress_bars():
        assert on_threads(abs, (-2, -3), name="within") == [2, 3]
        on_threads(abs, range(3))
    on_threads(abs, range(3), name="after")
    assert shown == [("within", 2)]
