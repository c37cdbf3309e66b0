"""What a second attempt at a job does again of what the first one had done when its process was killed."""

import statistics
import time
from dataclasses import dataclass

from harness import Row, gate, long_running, service, strip


def kept(database):
    """Intervals of the segments of tours that a search has solved and left for another attempt: how much
    of its work is done, for programs take as long as they have intervals."""
    [(done,)] = database.rows("SELECT coalesce(sum(intervals), 0) AS done FROM segments")
    return done


@dataclass
class Solved:
    """A job that has ended, what it took, and what was kept when it had taken half of that."""

    processor_s: float
    programs: int
    plan: dict
    half: int


def finish(running, job, database):
    """Waits for the end of a job."""
    course, end = [], time.monotonic() + 600.0
    while running.job(job)["finished_at"] is None:
        if time.monotonic() > end:
            raise RuntimeError(f"job {job} goes on")
        course.append((running.processor_s(), kept(database)))
        time.sleep(0.04)
    spent = running.processor_s()
    plan = running.request("GET", f"/v1/plans/{job}/result")[1]
    programs = plan.pop("statistics")["nlp_solves"]
    return Solved(spent, programs, plan, max(done for at, done in course if at <= 0.5 * spent))


def killed(database, scenario, half):
    """A job whose process was killed when so much was kept, and the processor time until then."""
    with service(database) as running:
        job = running.submit(scenario)
        while kept(database) < half:
            if running.job(job)["finished_at"] is not None:
                raise RuntimeError(f"job {job} ended before half of it was kept")
            time.sleep(0.01)
        spent = running.processor_s()
        running.kill()
    return job, spent


def legs_solved_again(scale):
    """Legs that a job had kept when it was killed in its search, and that are not found again before the next
    search. Further ones it solves when it needs them."""
    database = scale.database("j5-legs")
    with service(database) as running:
        job = running.submit(long_running())
        running.wait(job, lambda job: job["stage"] == "search", 600.0)
        running.kill()
    [(kept_legs,)] = database.rows("SELECT count(*) FROM legs")
    with service(database) as running:
        running.wait(job, lambda job: job["attempt"] == 2 and job["stage"] == "search", 600.0)
        figures = running.solver_of(job).request("GET", "/metrics")[1].decode()
        found = next(line.split()[-1] for line in figures.splitlines() if 'outcome="hit"' in line)
        return max(kept_legs - int(found), 0)


@gate("J5")
def rescued_work_is_reused(scale):
    """Killed where a cold run has done half of its work, a job needs little more than the other half.

    Where that is, is told by what has been solved, not by a clock: the work is the same every time. The
    processor time is not: while others use the machine equal work takes more of it, never less. So the
    least of three runs is judged, of cold ones and of second attempts at what one kill has left."""
    rounds, same, plans = scale.rounds(20, 1), 0, 0
    firsts, every, least, programs = [], [], [], []
    for number in range(rounds):
        scenario = strip(scale.of(18, 14), 0.01 * number)

        used = []

        def cold(name):
            database = scale.database(f"j5-{name}")
            used.append(database)
            with service(database) as running:
                return finish(running, running.submit(scenario), database)

        def second(name):
            database = left.copied(f"j5-{name}")
            used.append(database)
            with service(database) as running:
                return finish(running, job, database)

        colds, left = [cold("a"), cold("b")], scale.database("j5-left")
        job, spent = killed(left, scenario, statistics.mean(run.half for run in colds))
        seconds = [second("c")]
        colds.append(cold("d"))
        seconds += [second("e"), second("f")]
        usual = statistics.mean(run.processor_s for run in colds)
        firsts.append(spent / usual)
        every += [run.processor_s / usual for run in seconds]
        least.append(min(run.processor_s for run in seconds) / min(run.processor_s for run in colds))
        programs += [run.programs / colds[0].programs for run in seconds]
        plans += len(seconds)
        same += sum(run.plan == other.plan for run, other in zip(seconds, colds))
        times = [" ".join(f"{run.processor_s:.2f}" for run in runs) for runs in (colds, seconds)]
        print(f"    round {number}: cold {times[0]} s, until the kill {spent:.2f} s, second {times[1]} s", flush=True)
        for database in [*used, left]:
            database.removed()

    def row(promise, shares, judged=False):
        worst, median = 100 * max(shares), 100 * statistics.median(shares)
        holds = worst <= 60.0 if judged else None
        return Row("J5", f"{promise}, most of {len(shares)} (median {median:.0f} %)", f"{worst:.0f} %", "60 %", holds, timed=True)

    again = legs_solved_again(scale)
    return [
        Row("J5", "kept legs that are solved again after a kill during the search", str(again), "0", again == 0),
        row("processor time of the second attempt, least of 3", least, judged=True),
        # With what the neighbours of the machine add: shown, so that the difference is no secret.
        row("each time, of the mean of 3 cold ones", every),
        # The same every time, but early programs are short ones: their number is not the work.
        row("programs of the second attempt", programs),
        Row("J5", f"processor time until the kill, least (median {100 * statistics.median(firsts):.0f} %)", f"{100 * min(firsts):.0f} %", "-", None),
        Row("J5", f"plans equal to those never interrupted, of {plans}", str(same), str(plans), same == plans),
    ]
