"""Worker processes: answers, errors, deaths at any moment, processes that hang."""

import math
import multiprocessing
import operator
import os
import signal
import threading
import time

import pytest
from dentscope.campaigns import workers
from dentscope.campaigns.workers import answers


def test_each_order_has_its_answer_and_its_own_death(monkeypatch):
    monkeypatch.setattr(workers, "_TRIES", 1)
    orders = {
        "kills": (signal.raise_signal, signal.SIGKILL),
        "root": (math.sqrt, 9.0),
        "error": (int, "three"),
        "lock": (threading.Lock,),
        "name": (str.upper, "a"),
    }
    found = dict(answers(operator.call, orders, workers=2, timeout_s=300.0))
    assert found.keys() == orders.keys()
    assert (found["root"].value, found["name"].value) == (3.0, "A")
    assert found["error"].message.startswith("ValueError: invalid literal")
    assert "pickle" in found["lock"].message
    assert found["kills"].message == "the worker died 1 times"
    assert not multiprocessing.active_children()


@pytest.mark.parametrize("end", ["killed", "hung", "closed"])
def test_a_worker_that_ends_or_hangs_costs_no_other_order(monkeypatch, end):
    orders = {"a": (math.sqrt, 9.0), "b": (time.sleep, 3600.0 * (end != "killed"))}
    found = answers(operator.call, orders, workers=1, timeout_s=300.0)
    assert next(found)[1].value == 3.0
    (worker,) = multiprocessing.active_children()
    if end == "killed":
        os.kill(worker.pid, signal.SIGKILL)
        assert next(found) == ("b", workers.Answer())
    elif end == "hung":
        now = time.monotonic
        monkeypatch.setattr(workers.time, "monotonic", lambda: now() + 1e4)
        assert "hung" in next(found)[1].message
    found.close()
    assert not multiprocessing.active_children()
