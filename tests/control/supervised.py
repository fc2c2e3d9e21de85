"""A supervisor with a clock and an operator that tests turn by hand."""

from rover_pin.control.supervisor import Supervisor

ACTIONS = ("raise", "roll", "lower")


class Bench:
    """A supervisor on a clock of its own, and an operator who answers when told to.

    Attributes:
        now: what the clock tells.
        read: what it told last.
        answers: what the operator says.
        thinks: s that go by while the operator is asked.
        told: action, reason, count and deadline of each reminder.
    """

    def __init__(self, patience=10.0):
        self.now = self.read = 0.0
        self.answers = False
        self.thinks = 0.0
        self.told = []
        self.supervisor = Supervisor(self._clock, self._operator, patience)

    def _clock(self):
        self.read = self.now
        return self.now

    def _operator(self, reminder):
        self.told.append((reminder.action, reminder.reason, reminder.count, reminder.deadline))
        self.now += self.thinks
        return self.answers

    def report(self, after=1.0, **told):
        self.now += after
        return self.supervisor.report(**told)

    @property
    def trace(self):
        return [(e.time, str(e.state), e.action, e.reason) for e in self.supervisor.trace]


def begun(**options):
    bench = Bench(**options)
    bench.supervisor.begin("chassis_lifting", ACTIONS)
    return bench
