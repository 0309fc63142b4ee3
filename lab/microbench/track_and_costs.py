#!/usr/bin/env python3
"""Measures how fast Python tracks, against C++: track_and_costs.py BENCH_TRACK_AND_COSTS SCENE [FRAMES [ROUNDS]]

SCENE has ground truth. Each round runs the program of C++ and the same in Python. Prints frames per second and
batches of 1,024 costs per second of both, and the median of the rounds' ratios.
"""
import statistics
import subprocess
import sys
import time

import numpy as np

import hypotrack

WARM_UP, BATCHES = 10, 60  # those of track_and_costs.cpp


def per_second(calls, call):
    """Returns 1 / the median time of calls after the first WARM_UP."""
    seconds = []
    for i in range(calls):
        begin = time.perf_counter()
        call(i)
        seconds.append(time.perf_counter() - begin)
    return 1 / statistics.median(seconds[WARM_UP:])


def measure(file, count):
    session = hypotrack.Session(file)
    source = session.source()
    frames = [frame for _, frame in zip(range(count), source)]
    pictures = [[view.color for view in frame.views] for frame in frames]
    tracker = session.tracker(source.cameras)

    def track(i):
        if i == 0:  # with the truth, which the scene may start from
            solution = tracker.track(frames[0])
        else:
            solution = tracker.track(*pictures[i], time=frames[i].time)
        return solution.status, solution.landmarks

    tracked = per_second(len(frames), track)
    truth = frames[0].true_state
    states = truth + np.random.default_rng(1).normal(0, 0.01, (1024, truth.size))
    cost = session.frame_cost(source.cameras)
    cost.look(frames[0], truth)
    return tracked, per_second(BATCHES, lambda i: cost(states))


def main(program, file, count="140", rounds="5"):
    ratios = []
    for _ in range(int(rounds)):
        output = subprocess.run([program, file, count], check=True, text=True, stdout=subprocess.PIPE).stdout
        cpp, python = [float(number) for number in output.split()], measure(file, int(count))
        ratios.append([p / c for p, c in zip(python, cpp)])
        print("frames {:.1f} in C++, {:.1f} in Python; batches {:.1f}, {:.1f}".format(
            cpp[0], python[0], cpp[1], python[1]))
    frames, costs = (statistics.median(each) for each in zip(*ratios))
    print(f"Python / C++: frames {frames:.3f}, costs {costs:.3f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
