#!/usr/bin/env python3
"""Transfers every clip to every target on a cluster, and carries on where an earlier run ended.

A clip and a target are what the command takes: take.npy, takes/, actor/, actor@identity007=2. Each
pair is one job of one thread on one worker, whose output appears when it is whole; pairs whose
output is there are left out. Workers see the same files, by the same names. Without --scheduler a
cluster of --workers processes on this machine is started, and ended.

  clips_by_dask.py results --clips takes/*.npy --targets actor double@identity002=1
  clips_by_dask.py results --clips takes/*.npy --targets actor --scheduler tcp://head:8786

Needs mimetra's module on each worker's PYTHONPATH and Dask (Debian: python3-distributed). Ends with
1 where a pair could not be transferred, after all others."""

import argparse
import pathlib
import sys


def transfer(clip, target, out, k):
    import mimetra

    mimetra.transfer(clip, target, k=k, out=out, threads=1)


def output_of(folder, clip, target):
    return folder / f"{pathlib.Path(clip).stem}_{pathlib.Path(target).name}.npy"


def jobs_of(arguments):
    """Clip, target and output of each pair. Ends the program where two would write one file."""
    jobs = {}
    for clip in arguments.clips:
        for target in arguments.targets:
            out = output_of(arguments.out, clip, target)
            if out in jobs:
                sys.exit(f"{out}: {clip} to {target} and {jobs[out][0]} to {jobs[out][1]} would both"
                         " be written there; give them other names")
            jobs[out] = (clip, target)
    return [(clip, target, out) for out, (clip, target) in jobs.items()]


def client_of(distributed, arguments):
    if arguments.scheduler:
        return distributed.Client(arguments.scheduler)
    return distributed.Client(n_workers=arguments.workers, threads_per_worker=1,
                              dashboard_address=None)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--clips", nargs="+", required=True)
    parser.add_argument("--targets", nargs="+", required=True)
    parser.add_argument("-k", type=int, default=30)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--scheduler")
    arguments = parser.parse_args()
    try:
        import distributed
        import mimetra  # now, not on each of the workers
    except ImportError as error:
        sys.exit(f"clips_by_dask.py: {error}; install python3-distributed, and set PYTHONPATH to"
                 " mimetra's PREFIX/lib/python3/dist-packages")
    arguments.out.mkdir(parents=True, exist_ok=True)
    jobs = jobs_of(arguments)
    left = [job for job in jobs if not job[2].exists()]
    print(f"{len(jobs)} pairs, {len(jobs) - len(left)} of them done", flush=True)
    failed = 0
    with client_of(distributed, arguments) as client:
        running = {client.submit(transfer, clip, target, str(out), arguments.k, pure=False): out
                   for clip, target, out in left}
        for future in distributed.as_completed(running):
            if future.status == "error":
                failed += 1
                print(f"{running[future]}: {future.exception()}", file=sys.stderr, flush=True)
            else:
                print(running[future], flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
