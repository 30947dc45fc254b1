"""The benchmarks by name."""
from dataclasses import dataclass
from typing import Callable

AT_MOST, AT_LEAST = "<=", ">="


@dataclass(frozen=True)
class Benchmark:
    name: str
    unit: str
    sense: str
    limit: float
    long: bool
    needs: tuple  # groups of packages.txt, beside those that make-ready installs
    meaning: str  # one sentence
    measure: Callable[[], float]

    @property
    def goal(self):
        return f"{self.sense} {self.limit:g}"

    def holds(self, value):
        return value <= self.limit if self.sense == AT_MOST else value >= self.limit


BENCHMARKS = {}


def benchmark(name, unit, sense, limit, long=False, needs=()):
    """Registers a function that returns the figure or raises Failed. Its docstring says what the figure is."""
    def register(function):
        assert name not in BENCHMARKS, name
        meaning = " ".join((function.__doc__ or "").split())
        BENCHMARKS[name] = Benchmark(name, unit, sense, limit, long, needs, meaning, function)
        return function
    return register
