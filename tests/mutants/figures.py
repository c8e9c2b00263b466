"""Files of figures under data/validation."""

import csv


def replace_row(path, row, keys):
    """Writes a row of a CSV file, in place of the one with the same keys."""
    rows = {}
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            rows = {tuple(one[key] for key in keys): one for one in csv.DictReader(file)}
    rows[tuple(row[key] for key in keys)] = row
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, row, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows.values())
