"""Tables of docs/how/path-tracer.md."""
import scenes

TITLES = {name: title for name, title, _ in scenes.SCENES}


def percent(value, error):
    return "" if value is None else f"{100 * value:+.1f} ± {100 * error:.1f}"


def figures(row):
    return (f"{row['psnr']:.1f} | {row['flip']:.3f} | {percent(row['bias'], row['bias_error'])} | "
            f"{percent(row['media_bias'], row['media_bias_error'])}")


def table(found):
    lines = ["| scene | transport | PSNR [dB] | FLIP | mean bias [%] | bias where media are [%] | noise of the "
             "reference [dB] |", "| --- |" + " --- |" * 6]
    for name, modes in found["scenes"].items():
        for mode, row in modes.items():
            title = TITLES[name] if mode == "full" else ""
            lines.append(f"| {title} | {mode} | {figures(row)} | {row['reference_psnr']:.1f} |")
    return "\n".join(lines) + "\n"


def experiments_table(found):
    lines = ["| scene | what is changed | PSNR [dB] | FLIP | mean bias [%] | bias where media are [%] |",
             "| --- |" + " --- |" * 5]
    for row in found:
        lines.append(f"| {TITLES[row['scene']]}, {row['mode']} | {row['change']} | {figures(row)} |")
    return "\n".join(lines) + "\n"
