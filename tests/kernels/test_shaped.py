"""Films with a shape: equal to the literal scan, at every time step and at some of them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from literal import scan_trace

from lube.kernels.motion import surface_position
from lube.kernels.runs import BLOCK, BLOCK_SHIFT, highest_ahead
from lube.kernels.shaped import Surface, Window, answer_at, as_drawn, shaped_trace

seeds = st.integers(0, 2**32 - 1)
ratios = st.sampled_from([(1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (1.0, 0.37), (0.9, 1.0)])
sizes = st.integers(1, 4 * BLOCK)


def contact(seed, size_1, size_2, width):
    """Lines that are high here and there, and a film with a constriction."""
    random = np.random.default_rng(seed)
    lines = [
        (random.integers(-9, 9, size) * (random.random(size) < 0.3)).astype(np.int32)
        for size in (size_1, size_2)
    ]
    return tuple(lines), random.integers(2, 16, width)


@given(seeds, sizes, sizes, sizes, ratios, st.integers(0, 50), st.floats(0.0, 9.0))
def test_trace_equals_the_literal_scan(seed, size_1, size_2, width, ratios, before, factor):
    lines, film = contact(seed, size_1, size_2, width)
    films, factors = np.array([film, film[::-1] + 1]), np.array([factor, 2.0 * factor])
    surfaces, window = tuple(map(as_drawn, lines)), Window(films, before, BLOCK_SHIFT)
    traces = shaped_trace(surfaces, ratios, 29, 29, window, factors)
    for trace, *own in zip(traces, films, factors, strict=True):
        expected = scan_trace(lines, ratios, 29, own[0], before, own[1])
        np.testing.assert_array_equal(trace, expected)
    some = shaped_trace(surfaces, ratios, 29, 7, window, factors)
    np.testing.assert_array_equal(some, traces[:, np.arange(7) * 29 // 7])


def answered(line, random, nodes, functions):
    """Surface whose filtered lines and shapes are noise."""
    filtered = random.normal(0.0, 3.0, (line.size // 2 + 1, functions)).astype(np.float32)
    filtered = np.concatenate([filtered, filtered[:1]])
    return Surface(line, highest_ahead(line), filtered, random.normal(0.0, 1.0, (nodes, functions)))


def literal_answer(surface, place, node):
    """Sum over the functions, each filtered line read between its points."""
    rows = len(surface.filtered) - 1
    at = place % surface.line.size * rows / surface.line.size
    levels = [np.interp(at, np.arange(rows + 1), one) for one in surface.filtered.T]
    return np.dot(surface.shapes[node], levels)


@given(
    *(seeds, sizes, sizes, sizes, ratios),
    st.integers(0, 50),
    st.floats(0.0, 9.0),
    st.integers(0, BLOCK_SHIFT),
    st.integers(1, 3),
)
def test_answers_are_added_to_the_lines_at_every_point(
    seed, size_1, size_2, width, ratios, before, factor, shift, functions
):
    lines, film = contact(seed, size_1, size_2, width)
    random, step, phase = np.random.default_rng(seed), 1 << shift, -before % (1 << shift)
    nodes = width // step + BLOCK // step + 3
    surfaces = tuple(answered(line, random, nodes, functions) for line in lines)
    window, factors = Window(film[None], before, shift), np.array([factor])
    (every,) = shaped_trace(surfaces, ratios, 29, 29, window, factors)
    (some,) = shaped_trace(surfaces, ratios, 29, 10, window, factors)
    points = np.arange(width) + phase

    def answers_at(number):
        places = [surface_position(number, ratio) - before - phase for ratio in ratios]
        both = list(zip(surfaces, places, strict=True))
        surface, place = both[0]
        literal = literal_answer(surface, place + step, 1)
        assert np.isclose(answer_at(surface, place, step, 1), literal, atol=1e-4)
        return np.array(
            [
                round(sum(answer_at(one, at, step, node) for one, at in both))
                for node in range(nodes)
            ]
        )

    def expected(number, lift):
        node, part = points // step, points % step
        answers = lift[node] + (lift[node + 1] - lift[node]) * part // step
        overlap = answers - film
        for line, ratio in zip(lines, ratios, strict=True):
            at = surface_position(number, ratio) - before
            overlap = overlap + line[(at + np.arange(width)) % line.size]
        high = np.zeros(width + 2, np.int32)
        high[1:-1] = np.maximum(overlap, 0)
        one_window = (high, np.zeros_like(high))
        still = np.zeros(width + 2, int)
        return scan_trace(one_window, (1.0, 1.0), 1, still, 0, factor)[0].tolist()

    for number, found in enumerate(every):
        begin = number // step * step
        now, then = answers_at(begin), answers_at(begin + step)
        lift = now + (then - now) * (number - begin) // step
        assert found.tolist() == expected(number, lift)
    for number, found in zip(np.arange(10) * 29 // 10, some, strict=True):
        assert found.tolist() == expected(number, answers_at(number))
