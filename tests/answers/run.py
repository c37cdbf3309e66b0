#!/usr/bin/env python3
"""Do two builds of the program answer alike?

    SLEWPLAN=old/slewplan python3 tests/answers/run.py record before
    SLEWPLAN=new/slewplan python3 tests/answers/run.py record after --database-of before
    python3 tests/answers/run.py compare before after [--words]

`record` asks everything that the program can do, on its command line and as a service, and keeps the answers
in a folder, with the database of the service. `--database-of` also opens a copy of another recording's database.
`compare` lists what differs. What a run measures of itself (statistics, times of solving) is left out. Messages
are not compared; `--words` lists those that changed. Ends with 1 where answers differ.
"""

import argparse
import json
import shutil
import sys
from pathlib import Path

from comparing import compare

import questions
import served


def answers(work, before):
    yield from questions.everything(work)
    yield from served.everything(work, before)


def record(folder, before):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    asked = 0
    with (folder / "answers.jsonl").open("w") as file:
        for question, code, answer, messages in answers(folder, before):
            asked += 1
            json.dump({"question": question, "code": code, "answer": answer, "messages": messages}, file)
            file.write("\n")
            if asked % 500 == 0:
                print(f"{asked} answers; {question}", file=sys.stderr)
    print(f"{asked} answers in {folder}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    recording = commands.add_parser("record")
    recording.add_argument("folder", type=Path)
    recording.add_argument("--database-of", type=Path)
    comparing = commands.add_parser("compare")
    comparing.add_argument("before", type=Path)
    comparing.add_argument("after", type=Path)
    comparing.add_argument("--words", action="store_true")
    options = parser.parse_args()
    if options.command == "record":
        record(options.folder, options.database_of)
    else:
        sys.exit(compare(options.before, options.after, options.words))


main()
