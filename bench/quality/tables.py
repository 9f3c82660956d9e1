"""Tables of Markdown, and putting them into files."""
import re
import statistics


def number(value):
    return f"{value:.3g}"


def cell(numbers, spread=False):
    """The mean; "-" of nothing."""
    if not numbers:
        return "-"
    text = number(statistics.mean(numbers))
    return text + (f" ± {statistics.stdev(numbers):.2g}" if spread and len(numbers) > 1 else "")


def row(texts):
    return "| " + " | ".join(texts) + " |\n"


def table(head, rows):
    return row(head) + row(["---"] + ["---:"] * (len(head) - 1)) + "".join(map(row, rows))


def shares(hits):
    """Shares within one and two sigma, in per cent; "-" where there are no samples."""
    return "-" if hits is None else f"{100 * hits[0]:.0f} / {100 * hits[1]:.0f}"


def fill_in(template, parts):
    for name, part in parts.items():
        assert f"@{name}@" in template, f"the template has no @{name}@"
        template = template.replace(f"@{name}@", part.rstrip("\n"))
    left = re.findall(r"@[a-z_]+@", template)
    assert not left, f"nothing for {left}"
    return template


def replace(path, begin, end, text):
    """Puts text between two marks of a file."""
    old = path.read_text()
    pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
    assert pattern.search(old), f"{path}: no {begin}"
    path.write_text(pattern.sub(lambda _: begin + "\n" + text + end, old))
