"""Break many transfers of missions to an agent, and check that no partial and no old mission ever runs.

    python scripts/broken_transfers.py --transfers 200 --seed 1

The agent runs in its own process, reached over real sockets. Each transfer sends and starts a new signed mission, and
is broken at a random point in one of these ways:

    cut           the connection ends within the body
    corrupt       one to three bits of the body are flipped
    stuffed       bytes are appended to the body or cut off its end, with a matching Content-Length
    lost answer   from some byte on all data in one direction is dropped, so that the acknowledgement may be lost
    killed agent  kill -9 of the agent during the upload
    killed sender kill -9 of fieldhand send

After each transfer the agent is queried and its store is checked: it contains no partial mission; no mission has begun
without being complete and started; a waiting mission still waits; a mission that has run does not run again when it is
sent again. Then the mission is delivered normally and must run once, to its end.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from contextlib import closing, suppress
from datetime import datetime, timedelta
from hashlib import sha256
from pathlib import Path

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.approval.bundle.opening import unseal
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.compatibility import UTC
from fieldhand.delivery.json_models import AgentCommand, CommandResponse
from fieldhand.delivery.robot_client import RobotClient, open_client
from fieldhand.errors import DeliveryError, UnreachableError
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site, site_files
from fieldhand.task.build import make_task
from fieldhand.task.plan import Act

KINDS = ("cut", "corrupt", "stuffed", "lost answer", "killed agent", "killed sender")
TOKEN = "0123456789abcdef" * 2
#: Repeats of a command that the agent could not write to its disk in time, one per second.
_PATIENCE = 60


class AgentUnderTest:
    """An agent in its own process, with a sender's keys and missions."""

    def __init__(self, folder: Path, rng: random.Random) -> None:
        self.folder, self.rng = folder, rng
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        self.env = os.environ | {
            "FIELDHAND_CONFIG": str(folder / "config"),
            "FIELDHAND_OUTBOX": str(folder / "outbox"),
            "FIELDHAND_TOKEN": TOKEN,
        }
        self.site, self.robot = open_site("demo"), load_robot("husky")
        self.key, _ = SigningKeys(folder / "config").make("Ada", None)
        TrustStore(folder / "config").trust(self.key.public, name="Ada", at=datetime.now(UTC))
        self.at = datetime.now(UTC) - timedelta(days=1)
        self.process: subprocess.Popen[bytes] | None = None

    def begin(self) -> None:
        """Start the agent and wait until it answers."""
        command = [sys.executable, "-m", "fieldhand", "agent", "--robot", "husky", "--site", "demo"]
        command += ["--store", str(self.folder / "store"), "--port", str(self.port), "--speed", "max"]
        self.process = subprocess.Popen(command, env=self.env, stderr=subprocess.PIPE)
        for _ in range(2400):
            with suppress(OSError), closing(socket.create_connection(("127.0.0.1", self.port), timeout=1)):
                return
            if self.process.poll() is not None:
                raise SystemExit(f"the agent ended: {self.process.stderr.read()!r}")  # type: ignore[union-attr]
            time.sleep(0.05)
        raise SystemExit("the agent does not answer")

    def end(self, how: signal.Signals = signal.SIGTERM) -> None:
        """End the agent."""
        if self.process is not None:
            self.process.send_signal(how)
            self.process.communicate(timeout=60)

    def link(self) -> RobotClient:
        """Return a client of the agent."""
        return RobotClient(open_client(self.url, TOKEN, None))

    def bundle(self) -> bytes:
        """Return a new signed mission, approved one minute later than the one before."""
        self.at += timedelta(minutes=1)
        tree = str(self.rng.randint(1, len(self.site.trees)))
        task = make_task(
            request=f"Measure CO2 at tree {tree}, {self.at:%d %B at %H:%M}.",
            plan=Act(id="", action="read_co2", at=TreeIs(tree=tree)),
            measures={"read_co2": ("co2",)},
        )
        review = mission.review(task, self.site, self.robot)
        approved = mission.authorize(review, by="Ada", at=self.at, confirmed=EveryWarning())
        return pack(
            approved.authorized,
            self.site,
            self.robot,
            files=site_files("demo"),
            lenient=False,
            profile=profile_bytes("husky")[0],
            key=self.key,
            planner="script",
        )


def free_port() -> int:
    """Return a free port."""
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return int(tried.getsockname()[1])


def head(data: bytes, length: int) -> bytes:
    """Return the request line and headers of an upload."""
    return (
        f"PUT /agent/missions/{sha256(data).hexdigest()} HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        f"Authorization: Bearer {TOKEN}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    ).encode()


def upload(agent: AgentUnderTest, data: bytes, body: bytes, length: int) -> bytes:
    """Send a body as the upload of a bundle, and return the answer, empty if there is none."""
    with socket.create_connection(("127.0.0.1", agent.port), timeout=30) as link:
        answer = b""
        with suppress(OSError):
            link.sendall(head(data, length) + body)
            if len(body) < length:
                return answer
            while chunk := link.recv(65536):
                answer += chunk
    return answer


def cut(agent: AgentUnderTest, data: bytes) -> bool:
    """End the connection within the body."""
    point = agent.rng.randrange(len(data))
    upload(agent, data, data[:point], len(data))
    return False


def corrupt(agent: AgentUnderTest, data: bytes) -> bool:
    """Flip some bits of the body."""
    body = bytearray(data)
    for bit in agent.rng.sample(range(len(data) * 8), agent.rng.randint(1, 3)):
        body[bit // 8] ^= 1 << bit % 8
    answer = upload(agent, data, bytes(body), len(data))
    if b" 400 " not in answer[:20]:
        raise SystemExit(f"a corrupted upload was answered with {answer[:200]!r}")
    return False


def stuffed(agent: AgentUnderTest, data: bytes) -> bool:
    """Send a body longer or shorter than the mission, with a matching Content-Length."""
    more = agent.rng.randint(1, 5000)
    body = data + bytes(more) if agent.rng.random() < 0.5 else data[:-more]
    upload(agent, data, body, len(body))
    return False


def lost_answer(agent: AgentUnderTest, data: bytes) -> bool:
    """Send through a connection that drops all data in one direction after some bytes."""
    forward = agent.rng.random() < 0.5
    left = agent.rng.randrange(len(data) if forward else 3000)
    with socket.create_server(("127.0.0.1", 0)) as line:
        thread = threading.Thread(target=_relay, args=(line, agent.port, left, forward), daemon=True)
        thread.start()
        client = open_client(f"http://127.0.0.1:{line.getsockname()[1]}", TOKEN, None)
        with closing(RobotClient(client)) as link, suppress(DeliveryError):
            link.deliver(data, unseal(data, source="m").hashes)
            link.order(sha256(data).hexdigest(), "start")
        thread.join(10)
    return True


def _relay(line: socket.socket, port: int, left: int, forward: bool) -> None:
    """Relay connections until ``left`` bytes have passed in one direction; then drop everything."""
    line.settimeout(5)
    while left > 0:
        try:
            near, _ = line.accept()
        except OSError:
            return
        with near, socket.create_connection(("127.0.0.1", port)) as far:
            while left > 0:
                ready, _, _ = select.select([near, far], [], [], 5)
                if not ready:
                    return
                for one in ready:
                    chunk = b""
                    with suppress(OSError):
                        chunk = one.recv(4096)
                    if not chunk:
                        break
                    if (one is near) == forward:
                        chunk = chunk[:left]
                        left -= len(chunk)
                    with suppress(OSError):
                        (far if one is near else near).sendall(chunk)
                else:
                    continue
                break


def killed_agent(agent: AgentUnderTest, data: bytes) -> bool:
    """Kill the agent at a random moment of an upload, or shortly after."""
    wait = agent.rng.uniform(0.0, 0.5)
    kill = threading.Timer(wait, lambda: agent.end(signal.SIGKILL))
    pace = agent.rng.uniform(0.0, 0.2)
    with suppress(OSError), socket.create_connection(("127.0.0.1", agent.port), timeout=5) as link:
        kill.start()
        link.sendall(head(data, len(data)))
        for k in range(0, len(data), 8192):
            link.sendall(data[k : k + 8192])
            time.sleep(pace / (len(data) / 8192))
        link.recv(4096)
    kill.join()
    agent.begin()
    return True


def killed_sender(agent: AgentUnderTest, data: bytes) -> bool:
    """Kill ``fieldhand send --start`` at a random moment, then send the missions left in its outbox."""
    shutil.rmtree(agent.folder / "outbox", ignore_errors=True)
    file = agent.folder / "m.mission"
    file.write_bytes(data)
    command = [sys.executable, "-m", "fieldhand", "send", str(file), "--to", agent.url, "--start"]
    sender = subprocess.Popen(command, env=agent.env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    # Starting takes most of its time; the kill must come around or after the moment at which it stores the mission.
    until = time.monotonic() + 60.0
    while sender.poll() is None and not (agent.folder / "outbox").exists() and time.monotonic() < until:
        time.sleep(0.002)
    with suppress(subprocess.TimeoutExpired):
        sender.wait(agent.rng.uniform(0.0, 0.8))
    sender.kill()
    sender.wait()
    pending = [sys.executable, "-m", "fieldhand", "send", "--pending"]
    subprocess.run(pending, env=agent.env, capture_output=True, timeout=120, check=False)
    return True


BREAK = {
    "cut": cut,
    "corrupt": corrupt,
    "stuffed": stuffed,
    "lost answer": lost_answer,
    "killed agent": killed_agent,
    "killed sender": killed_sender,
}


class Judge:
    """Checks of the agent's store that must pass at any time."""

    def __init__(self, agent: AgentUnderTest) -> None:
        self.agent = agent
        self.whole: dict[str, bytes] = {}
        self.allowed: set[str] = set()

    def errors(self) -> list[str]:
        """Return what is wrong in the store, one sentence each."""
        store, wrong = self.agent.folder / "store", list[str]()
        wrong += [
            f"{path.name} is no whole mission"
            for path in (store / "bundles").iterdir()
            if self.whole.get(path.stem) != path.read_bytes()
        ]
        names = {one[:16] for one in self.allowed}
        for path in (store / "missions").iterdir():
            if path.name not in names:
                wrong.append(f"mission {path.name} has begun and was not told to")
            log = path / "events.jsonl"
            kinds = [json.loads(line)["event"] for line in log.read_text().splitlines()] if log.exists() else []
            if kinds.count("started") > 1 or kinds.count("mission") > 1:
                wrong.append(f"mission {path.name} has run twice")
        return wrong


def give(link: RobotClient, name: str, command: AgentCommand) -> CommandResponse:
    """Give a mission a command, again while the agent answers that its disk is too slow: commands are idempotent."""
    for _ in range(_PATIENCE):
        with suppress(UnreachableError):
            return link.order(name, command)
        time.sleep(1.0)
    return link.order(name, command)


def transfer(
    agent: AgentUnderTest, judge: Judge, kind: str, waiting: str, before: bytes | None
) -> tuple[list[str], bool]:
    """Break one transfer, check the agent, then deliver the mission normally.

    Returns:
        Errors, one sentence each, and True if the mission had arrived in spite of the broken transfer.
    """
    data = agent.bundle()
    name = sha256(data).hexdigest()
    judge.whole[name] = data
    may_start = BREAK[kind](agent, data)
    if may_start:
        judge.allowed.add(name)
    with closing(agent.link()) as link:
        arrived = link.mission(name)
        wrong = judge.errors()
        if arrived is not None and not may_start:
            wrong.append(f"{kind}: a broken upload is there")
        held = link.mission(waiting)
        if held is None or held.mission.state != "waiting":
            wrong.append("the mission that waits does not wait any more")
        if before is not None:
            again = link.deliver(before, unseal(before, source="m").hashes)
            state = give(link, again.mission.bundle, "start").mission
            if again.new or state.state != "ended":
                wrong.append(f"a mission that has run is {state.state} after it was sent again")
        judge.allowed.add(name)
        link.deliver(data, unseal(data, source="m").hashes)
        give(link, name, "start")
        for _ in range(2400):
            stands = link.events(name, 0, 0.2)
            if stands.idle and stands.mission.state == "ended":
                break
            if stands.mission.state == "interrupted" and stands.idle:
                give(link, name, "resume")
        else:
            wrong.append(f"mission {name[:16]} does not end: {stands.mission}")
        if stands.mission.status != "completed":
            wrong.append(f"mission {name[:16]} ended {stands.mission.status}")
    return wrong + judge.errors(), arrived is not None


def main() -> None:
    """Break transfers, and print their number and the errors found."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--transfers", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="only these")
    given = parser.parse_args()
    rng = random.Random(given.seed)
    broken, arrived, wrong = Counter[str](), Counter[str](), list[str]()
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        agent = AgentUnderTest(Path(folder), rng)
        judge = Judge(agent)
        agent.begin()
        try:
            old = agent.bundle()
            waiting = sha256(old).hexdigest()
            judge.whole[waiting] = old
            with closing(agent.link()) as link:
                link.deliver(old, unseal(old, source="m").hashes)
            before: bytes | None = None
            for number in range(1, given.transfers + 1):
                kind = rng.choice(given.kinds)
                found, came = transfer(agent, judge, kind, waiting, before)
                broken[kind] += 1
                arrived[kind] += came
                wrong += [f"transfer {number}, {kind}: {one}" for one in found]
                before = judge.whole[list(judge.whole)[-1]]
                if number % 20 == 0:
                    print(f"{number} transfers, {len(wrong)} wrong, {time.monotonic() - begun:.0f} s", flush=True)
        finally:
            agent.end()
    for line in wrong:
        print(line)
    print(f"\n{'broken by':<15}{'transfers':>10}{'had arrived all the same':>26}")
    for kind in KINDS:
        print(f"{kind:<15}{broken[kind]:>10}{arrived[kind]:>26}")
    print(f"{sum(broken.values())} broken transfers, {len(wrong)} wrong, in {time.monotonic() - begun:.0f} s")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
