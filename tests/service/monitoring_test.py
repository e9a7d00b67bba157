#!/usr/bin/env python3
"""Queries of the Grafana dashboard and of the alerts ask for what a server has, and the page of
operations lists all of it.

usage: monitoring_test.py TRIBODYND DEPLOY_FOLDER
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

import yaml

SERIES = re.compile(r"\b((?:tribodyn|process)_\w+)(?:\{([^}]*)\})?")


def exposed(text):
    """Returns the names of the labels of each metric in a page of Prometheus' text format."""
    out = {}
    for line in text.splitlines():
        if found := SERIES.match(line):
            labels = re.findall(r'(\w+)="', found[2] or "")
            out.setdefault(found[1], set()).update(labels)
    return out


def mistakes(query, metrics):
    """Yields what a query asks for and no server has."""
    names = SERIES.findall(query)
    if not names:
        yield f"no metric in: {query}"
    known = {"job", "instance"}
    for name, matchers in names:
        if name not in metrics:
            yield f"no metric {name}: {query}"
        known |= metrics.get(name, set())
        for label in re.findall(r"(\w+)\s*[=!]", matchers):
            if label not in metrics.get(name, set()):
                yield f"{name} has no label {label}: {query}"
    for group in re.findall(r"\b(?:by|on)\s*\(([^)]*)\)", query):
        for label in re.split(r",\s*", group):
            if label not in known:
                yield f"no label {label}: {query}"


def page_of(server, folder):
    """Starts a server, makes a call, and returns its metrics."""
    log = folder / "log"
    command = [server, "--database", folder / "x.sqlite", "--listen", f"unix:{folder}/grpc"]
    with log.open("w") as output:
        process = subprocess.Popen(
            [*command, "--http-listen", "127.0.0.1:0", "--port-file", folder / "port"],
            stdout=output,
            stderr=output,
        )
    try:
        while not (folder / "port").exists():
            assert process.poll() is None, log.read_text()
            time.sleep(0.05)
        address = re.search(r"REST at (http://\S+)", log.read_text())[1]
        token = (folder / "x.sqlite.token").read_text().strip()
        for path in ("/v1/lubricants", "/metrics"):
            request = urllib.request.Request(
                address + path, headers={"Authorization": f"Bearer {token}"}
            )
            with urllib.request.urlopen(request, timeout=60) as answer:
                text = answer.read().decode()
        return text
    finally:
        process.terminate()
        process.wait()


def main(server, deploy):
    with tempfile.TemporaryDirectory() as folder:
        page = page_of(server, pathlib.Path(folder))
    metrics = exposed(page)
    dashboard = json.loads((deploy / "grafana/tribodyn.json").read_text())
    rules_file = deploy / "prometheus/tribodyn.rules.yml"
    groups = yaml.safe_load(rules_file.read_text())["groups"]
    rules = [rule for group in groups for rule in group["rules"]]
    found = []
    targets = [target for panel in dashboard["panels"] for target in panel["targets"]]
    for query in [each["expr"] for each in targets + rules]:
        found += mistakes(query, metrics)
    for rule in rules:
        lacks = {"alert", "expr", "for", "labels", "annotations"} - set(rule)
        found += [f"an alert lacks {each}: {rule}" for each in lacks]
    families = set(re.findall(r"^# TYPE (\w+)", page, re.M))
    listed = {name for name, _ in SERIES.findall((deploy / "OPERATIONS.md").read_text())}
    found += [f"OPERATIONS.md lacks {name}" for name in families - listed]
    found += [f"OPERATIONS.md lists {name}, which no server has" for name in listed - families]
    asked = {name for each in targets + rules for name, _ in SERIES.findall(each["expr"])}
    assert len(asked) > 20, asked
    for query in ('tribodyn_none > 0', 'sum by (colour) (tribodyn_campaigns{size="1"})', "1"):
        assert list(mistakes(query, metrics)), f"the test accepts {query}"
    if promtool := shutil.which("promtool"):
        if subprocess.run([promtool, "check", "rules", rules_file]).returncode:
            found.append("promtool refuses the rules")
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
