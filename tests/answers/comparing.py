"""What differs between two recordings."""

import json
import re

# What a run measures of itself.
MEASURED = {"statistics", "solve_time_s", "wall_time_s", "queued_s", "solved_s"}
# The same in text: how long the work took, and when a file was written.
MEASURED_TEXT = re.compile(r"(?<=work {10})[\d.]+ s|(?<=CREATION_DATE)( = |>)[\dT:.Z-]+")
# What people read, and programs do not.
WORDS = {"message", "hint", "detail", "title", "description", "summary"}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def recorded(folder):
    """The answers of a recording; a question that is asked again is another one."""
    found, times = {}, {}
    for line in (folder / "answers.jsonl").open():
        answer = json.loads(line)
        question = answer["question"]
        times[question] = times.get(question, 0) + 1
        found[question, times[question]] = answer
    return found


def parsed(text):
    try:
        return json.loads(text)
    except ValueError:
        return MEASURED_TEXT.sub("<measured>", text).splitlines()


def walked(before, after, path, words):
    """The places where two answers differ; messages go to `words`."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in [*before, *(key for key in after if key not in before)]:
            if key in MEASURED:
                continue
            if key in WORDS and isinstance(before.get(key), str) and isinstance(after.get(key), str):
                if before[key] != after[key]:
                    words.setdefault((before[key], after[key]), path)
                continue
            yield from walked(before.get(key, "(missing)"), after.get(key, "(missing)"), f"{path}/{key}", words)
        if list(before) != list(after) and set(before) == set(after):
            yield path, "order of members", list(before), list(after)
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, (one, other) in enumerate(zip(before, after)):
            yield from walked(one, other, f"{path}/{index}", words)
    elif before != after or type(before) is not type(after):
        yield path, "value", before, after


def moved(before, after):
    """The largest relative change of the numbers in two values that are alike but for those; else none."""
    one, other = (NUMBER.findall(json.dumps(value)) for value in (before, after))
    if NUMBER.sub("#", json.dumps(before)) != NUMBER.sub("#", json.dumps(after)):
        return None
    pairs = [(float(a), float(b)) for a, b in zip(one, other)]
    return max((abs(a - b) / max(abs(a), abs(b)) for a, b in pairs if a != b), default=0.0)


def compare(before, after, show_words):
    """Prints what differs; 1 if anything does."""
    old, new, words, different = recorded(before), recorded(after), {}, 0
    # What is kept in the database of before is what was stored there.
    old.update({(f"kept{name.removeprefix('stored')}", time): answer for (name, time), answer in [*old.items()] if name.startswith("stored")})
    for key in [*old, *(key for key in new if key not in old)]:
        question = key[0] + (f" ({key[1]})" if key[1] > 1 else "")
        if key not in old or key not in new:
            print(f"{question}: only {'before' if key in old else 'after'}")
            different += 1
            continue
        one, other = old[key], new[key]
        if one["messages"] != other["messages"]:
            words.setdefault((one["messages"], other["messages"]), question)
        found = [("", "code", one["code"], other["code"])] if one["code"] != other["code"] else []
        if question.startswith("help "):
            if one["answer"] != other["answer"]:
                words.setdefault((one["answer"], other["answer"]), question)
        else:
            found += walked(parsed(one["answer"]), parsed(other["answer"]), "", words)
        if found:
            different += 1
            changes = [moved(*difference[2:]) for difference in found]
            if None in changes:
                at = found[changes.index(None)]
                print(f"{question}: {len(found)} places; {at[0]} {at[1]}: {str(at[2])[:120]} -> {str(at[3])[:120]}")
            else:
                print(f"{question}: {len(found)} numbers, by at most {max(changes):.1e} of themselves")
    if show_words:
        for (one, other), place in words.items():
            print(f"- {one}\n+ {other}    [{place}]")
    print(f"{len(old)} answers, {different} different; {len(words)} messages changed")
    return int(different > 0)
