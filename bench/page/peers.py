"""The claimed figures beside other renderers, as results of `brume bench`: multiples of what another one takes, from
the results of script/bench-peers and script/compare-cycles."""
import re

CPU, ERROR, FOG = "peers/vdb_render/cpu", "peers/vdb_render/error", "peers/nanovdb/gpu"
CYCLES_TIME, CYCLES_MEAN = "peers/cycles/time", "peers/cycles/mean"
OF_BENCH_PEERS, OF_COMPARE_CYCLES = (CPU, ERROR, FOG), (CYCLES_TIME, CYCLES_MEAN)


def result(name, value, unit, clock, **details):
    return {"name": name, "unit": unit, "clock": clock, "median": value, "min": value, "max": value, "repetitions": 1,
            "details": details}


def multiple(name, ours, theirs, clock):
    """Nothing where one of both is missing."""
    return [result(name, ours / theirs, "times", clock, brume=ours, other=theirs)] if ours and theirs else []


def of_bench_peers(results):
    rows = results["renderers"]
    brume = next((row for row in rows if row["renderer"] == "Brume, lavapipe"), {})
    other = next((row for row in rows if re.fullmatch(r"vdb_render[ .\d]*", row["renderer"])), {})
    fog = {found[1]: float(found[2]) for line in results["nanovdb"]
           if (found := re.match(r"(\S+) +median +([\d.e+-]+) ", line))}
    return (multiple(CPU, brume.get("cpu"), other.get("cpu"), "cpu") +
            multiple(ERROR, brume.get("rmse"), other.get("rmse"), "none") +
            multiple(FOG, fog.get("volumes/fog_sphere"), fog.get("nearest"), "gpu"))


def of_compare_cycles(results):
    """Time at equal error, of the fastest of Cycles' settings; the largest difference of a picture's mean, of scenes
    whose surfaces are the same in both."""
    found, apart = [], [abs(row["whole"]) for row in results["scenes"] if row["same_model"]]
    if results["speed"]:
        brume, *others = results["speed"]["rows"]
        found += multiple(CYCLES_TIME, brume["cost"], min(row["cost"] for row in others), "cpu")
    if apart:
        found.append(result(CYCLES_MEAN, 100 * max(apart), "%", "none", scenes=len(apart)))
    return found
