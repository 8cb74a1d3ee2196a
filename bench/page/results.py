"""Reads what `brume bench --json` writes, and the figures that the documentation claims."""
import dataclasses
import json
import math
import pathlib

MAX_BYTES = 64 << 20
CLAIMS = pathlib.Path(__file__).with_name("claims.json")


class BadResults(Exception):
    """One line for the user."""


@dataclasses.dataclass(frozen=True)
class Measurement:
    name: str
    unit: str
    clock: str
    median: float
    min: float
    max: float
    repetitions: int
    details: dict


@dataclasses.dataclass(frozen=True)
class Results:
    """One file: where it was measured, and what."""
    file: str
    device: str
    driver: str
    processor: str
    threads: int
    commit: str
    measurements: dict  # by name, in their order
    skipped: list

    @property
    def is_software(self):
        return "llvmpipe" in self.device.lower()

    def reason_without(self, case):
        """Why brume bench skipped a case, in its words; empty if it did not."""
        return next((line[len(case) + 2:] for line in self.skipped if line.startswith(case + ": ")), "")


def member(values, key, kind, place):
    """A member of a JSON object. `kind`: str, list, dict, int or float (a finite number that is not negative)."""
    names = {str: "a text", list: "a list", dict: "an object", int: "a whole number", float: "a number from 0"}
    value = values.get(key)
    if kind is float and type(value) in (int, float):
        value = float(value) if abs(value) < 1e300 else math.nan
        if math.isfinite(value) and value >= 0:
            return value
    elif type(value) is kind and (kind is not int or value >= 0):
        return value
    raise BadResults(f"{place}: expected {names[kind]} as \"{key}\"; write the file again by brume bench --json")


def secondary(value, place):
    """A number of any sign, or nothing where brume bench found none."""
    if value is not None and (type(value) not in (int, float) or not abs(value) < 1e300):
        raise BadResults(f"{place}: expected numbers; write the file again by brume bench --json")
    return value


def measurement(values, place):
    if type(values) is not dict:
        raise BadResults(f"{place}: expected an object; write the file again by brume bench --json")
    name = member(values, "name", str, place)
    numbers = {key: member(values, key, float, place) for key in ("median", "min", "max")}
    if not numbers["min"] <= numbers["median"] <= numbers["max"]:
        raise BadResults(f"{place}: expected min <= median <= max; write the file again by brume bench --json")
    details = member(values, "details", dict, place) if "details" in values else {}
    return Measurement(name, member(values, "unit", str, place), member(values, "clock", str, place), **numbers,
                       repetitions=member(values, "repetitions", int, place),
                       details={key: secondary(value, f"{place}: details") for key, value in details.items()})


def parse(path):
    try:
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise BadResults(f"{path}: {error.strerror}; expected a file of brume bench --json") from error
    if len(data) > MAX_BYTES:
        raise BadResults(f"{path}: larger than 64 MiB; expected a file of brume bench --json")
    try:
        return json.loads(data.decode("utf-8"))
    except json.JSONDecodeError as error:
        raise BadResults(f"{path}:{error.lineno}:{error.colno}: {error.msg}; expected JSON of brume bench --json"
                         ) from error
    except (ValueError, RecursionError) as error:
        raise BadResults(f"{path}: not JSON of brume bench --json; write it again") from error


def load(path):
    """Raises BadResults unless the file is one of brume bench."""
    values = parse(path)
    if type(values) is not dict or values.get("command") != "bench" or values.get("schema") != 1:
        raise BadResults(f"{path}: not of brume bench: expected \"schema\" 1 and \"command\" \"bench\"")
    found = {}
    for i, entry in enumerate(member(values, "results", list, path)):
        one = measurement(entry, f"{path}: results[{i}]")
        if one.name in found:
            raise BadResults(f"{path}: results[{i}]: \"{one.name}\" twice; write the file again by brume bench --json")
        found[one.name] = one
    skipped = member(values, "skipped", list, path)
    if any(type(line) is not str for line in skipped):
        raise BadResults(f"{path}: expected texts in \"skipped\"; write the file again by brume bench --json")
    texts = {key: member(values, key, str, path) for key in ("device", "driver", "processor", "commit")}
    return Results(file=pathlib.Path(path).name, threads=member(values, "threads", int, path), measurements=found,
                   skipped=skipped, **texts)


def claims():
    """Of the README and other pages, each with
    - what: a title, page: where it stands, text: the passage, figure: its part that says how much,
    - condition: texts that every page with the figure has, too, on: the machine it is of,
    - case: the name of the result, detail: of a secondary one, run: what brume bench calls the case, if otherwise,
    - value and unit: the figure as a number, where it is one,
    - by: the script that adds the case to those of brume bench, where one does (peers.py)."""
    return json.loads(CLAIMS.read_text(encoding="utf-8"))
