#!/usr/bin/env python3
"""What failing nodes cost a render of 16384 x 16384 pixels in 64 channels on 1,000 nodes, by simulation.

The film is cut into 1,024 crops, each with its own job array of 4 ranges of samples, of 2.5 hours each: 10,240 node hours. Nodes fail at random,
independently, once in 100 hours of work on average, and are back after half an hour; their task goes on from its last checkpoint elsewhere.
"""
import heapq
import random

NODES, TASKS, TASK_HOURS = 1000, 1024 * 4, 2.5
FAILURES_PER_HOUR, REPAIR_HOURS = 0.01, 0.5
CROP_GB = 512 * 512 * 64 * 8 * 16 / 1e9  # pixels, channels, replicates, bytes of a sum
WRITE_HOURS = CROP_GB / 0.18 / 3600  # at 0.18 GB/s, with its hash, flushed and read back


def simulate(interval, failures_per_hour, seed=1):
    """Hours, failures, lost and paid node hours, with a checkpoint after every `interval` hours of work; none: never."""
    rng = random.Random(seed)
    step = interval or TASK_HOURS
    write = WRITE_HOURS
    waiting, idle, events = [0.0] * TASKS, list(range(NODES)), []  # hours of each task that are saved
    now, done, failures, lost, paid = 0.0, 0, 0, 0.0, 0.0
    while done < TASKS:
        while waiting and idle:
            saved, node = waiting.pop(), idle.pop()
            left = TASK_HOURS - saved
            lasts = left + write * -(-left // step)  # the last is the part
            fails = rng.expovariate(failures_per_hour) if failures_per_hour else float("inf")
            paid += min(lasts, fails)
            heapq.heappush(events, (now + min(lasts, fails), node, saved, fails if fails < lasts else None))
        now, node, saved, failed = heapq.heappop(events)
        if node < 0:
            idle.append(-node - 1)
        elif failed is None:
            done += 1
            idle.append(node)
        else:
            kept = int(failed / (step + write)) * step if interval else 0.0
            failures += 1
            lost += failed - kept
            waiting.append(saved + kept)
            heapq.heappush(events, (now + REPAIR_HOURS, -node - 1, 0.0, None))
    return now, failures, lost, paid


def main():
    print("| checkpoint after | nodes fail | failures | lost node hours | of all work | paid node hours | hours |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for rate in (0, FAILURES_PER_HOUR):
        for name, interval in (("none", None), ("1 h", 1.0), ("20 min", 1 / 3), ("3 min", 0.05)):
            hours, failures, lost, paid = simulate(interval, rate)
            share = 100 * lost / (TASKS * TASK_HOURS)
            percent = f"{100 * rate:.0f} %/h" if rate else "never"
            print(f"| {name} | {percent} | {failures} | {lost:.0f} | {share:.2f} % | {paid:.0f} | {hours:.2f} |")


main()
