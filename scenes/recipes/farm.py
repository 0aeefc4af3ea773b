#!/usr/bin/env python3
"""A journal on a farm: chunks of about the same cost, as tasks that add up in one run folder.

usage: farm.py CACHE JOURNAL RUN [--seconds S] [--sbatch WORDS | --local N]

Asks `relook plan` what the steps cost, and writes RUN.sbatch: a Slurm array with a task for each chunk (--seconds of
work, 60). --sbatch submits it with these words (--sbatch="--partition=night --cpus-per-task=8 --time=1:00:00"); --local
runs the same tasks here, N at once. Any order will do, and a task that was ended goes on where it was: near its time limit
(a notice by USR1, exit code 138) and when another is at its steps (75) it asks Slurm for another try. RUN/report.html is
whole when the last task has ended.
"""

import argparse
import concurrent.futures
import shlex
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "cli/python"), str(HERE.parents[2] / "python")]  # sources; as installed
import relook  # noqa: E402

SCRIPT = """#!/bin/bash
#SBATCH --job-name=relook
#SBATCH --array=0-{last}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@30
ranges=({ranges})
trap 'kill -USR1 $task' USR1  # the time limit is near
{command} --steps="${{ranges[$SLURM_ARRAY_TASK_ID]}}" --threads="${{SLURM_CPUS_PER_TASK:-0}}" &
task=$!
wait $task; code=$?
while kill -0 $task 2>/dev/null; do wait $task; code=$?; done
case $code in 75 | 138) scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID" ;; esac
exit $code
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cache", "journal", "run"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--sbatch", metavar="WORDS")
    parser.add_argument("--local", type=int, metavar="N")
    arguments = parser.parse_args()
    inputs = [path.resolve() for path in (arguments.cache, arguments.journal, arguments.run)]
    ranges = relook.chunks(relook.plan(*inputs[:2]), arguments.seconds)
    print(f"{len(ranges)} tasks: {' '.join(ranges)}")
    if arguments.local:
        def task(steps):
            return relook.replay(*inputs, steps=steps, threads=1)

        with concurrent.futures.ThreadPoolExecutor(arguments.local) as pool:
            list(pool.map(task, ranges))
        report = relook.Report.read(inputs[2])
        print(f"{len(report.frames())} frames in {inputs[2]}")
        return
    script = Path(f"{inputs[2]}.sbatch")
    words = " ".join(map(shlex.quote, relook.command("replay", *inputs[:2], output=inputs[2])))
    script.write_text(SCRIPT.format(last=len(ranges) - 1, ranges=" ".join(ranges), command=words))
    print(script)
    if arguments.sbatch is not None:
        subprocess.run(["sbatch", *shlex.split(arguments.sbatch), str(script)], check=True)


if __name__ == "__main__":
    try:
        main()
    except relook.RelookError as error:
        sys.exit(f"relook: {error}")
