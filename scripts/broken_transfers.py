"""Break many transfers of missions to an agent, and see that no partial and no old mission ever runs.

    python scripts/broken_transfers.py --transfers 200 --seed 1

An agent runs as a process of its own, over real sockets. Each transfer brings it a new signed mission that is to be
started, and is broken in one of these ways, at a random point:

    cut           the connection ends within the body
    corrupt       one to three bits of the body are flipped
    stuffed       bytes are added to the body, or left out, beside a right Content-Length
    lost answer   all that goes one way or the other is dropped from some byte on: also the acknowledgement is lost
    killed agent  kill -9 while the upload runs
    killed sender kill -9 of fieldhand send

After each of them the agent is asked, and its store is looked into: what was not whole is not there; nothing has begun
that was not whole and told to start; a mission that waits still waits; one that ran does not run again when it is sent
again. Then the mission is delivered as any sender would do it, and has to run, once, to its end.
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
from datetime import UTC, datetime, timedelta
from hashlib import sha256
from pathlib import Path

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.approval.bundle.opening import unseal
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.delivery.robot_client import RobotClient, open_client
from fieldhand.errors import DeliveryError
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site, site_files
from fieldhand.task.build import make_task
from fieldhand.task.plan import Act

KINDS = ("cut", "corrupt", "stuffed", "lost answer", "killed agent", "killed sender")
TOKEN = "0123456789abcdef" * 2


class Field:
    """A robot's agent as a process, and who sends to it."""

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
        self.agent: subprocess.Popen[bytes] | None = None

    def begin(self) -> None:
        """Start the agent and wait until it answers."""
        command = [sys.executable, "-m", "fieldhand", "agent", "--robot", "husky", "--site", "demo"]
        command += ["--store", str(self.folder / "store"), "--port", str(self.port), "--speed", "max"]
        self.agent = subprocess.Popen(command, env=self.env, stderr=subprocess.PIPE)
        for _ in range(2400):
            with suppress(OSError), closing(socket.create_connection(("127.0.0.1", self.port), timeout=1)):
                return
            if self.agent.poll() is not None:
                raise SystemExit(f"the agent ended: {self.agent.stderr.read()!r}")  # type: ignore[union-attr]
            time.sleep(0.05)
        raise SystemExit("the agent does not answer")

    def end(self, how: signal.Signals = signal.SIGTERM) -> None:
        """End the agent."""
        if self.agent is not None:
            self.agent.send_signal(how)
            self.agent.communicate(timeout=60)

    def link(self) -> RobotClient:
        """A sender's link."""
        return RobotClient(open_client(self.url, TOKEN, None))

    def bundle(self) -> bytes:
        """A new mission, approved a little later than the one before."""
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
    """A port that nothing listens on."""
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return int(tried.getsockname()[1])


def head(data: bytes, length: int) -> bytes:
    """The head of an upload."""
    return (
        f"PUT /agent/missions/{sha256(data).hexdigest()} HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        f"Authorization: Bearer {TOKEN}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    ).encode()


def upload(field: Field, data: bytes, body: bytes, length: int) -> bytes:
    """Send these bytes as the upload of that bundle, and give the answer, if there is one."""
    with socket.create_connection(("127.0.0.1", field.port), timeout=30) as link:
        answer = b""
        with suppress(OSError):
            link.sendall(head(data, length) + body)
            if len(body) < length:
                return answer
            while chunk := link.recv(65536):
                answer += chunk
    return answer


def cut(field: Field, data: bytes) -> bool:
    """End the connection within the body."""
    point = field.rng.randrange(len(data))
    upload(field, data, data[:point], len(data))
    return False


def corrupt(field: Field, data: bytes) -> bool:
    """Flip some bits of the body."""
    body = bytearray(data)
    for bit in field.rng.sample(range(len(data) * 8), field.rng.randint(1, 3)):
        body[bit // 8] ^= 1 << bit % 8
    answer = upload(field, data, bytes(body), len(data))
    if b" 400 " not in answer[:20]:
        raise SystemExit(f"a corrupted upload was answered with {answer[:200]!r}")
    return False


def stuffed(field: Field, data: bytes) -> bool:
    """Say another length than the mission has, with as many bytes."""
    more = field.rng.randint(1, 5000)
    body = data + bytes(more) if field.rng.random() < 0.5 else data[:-more]
    upload(field, data, body, len(body))
    return False


def lost_answer(field: Field, data: bytes) -> bool:
    """Send through a line that goes dead after some bytes in one of its directions."""
    forward = field.rng.random() < 0.5
    left = field.rng.randrange(len(data) if forward else 3000)
    with socket.create_server(("127.0.0.1", 0)) as line:
        thread = threading.Thread(target=_relay, args=(line, field.port, left, forward), daemon=True)
        thread.start()
        client = open_client(f"http://127.0.0.1:{line.getsockname()[1]}", TOKEN, None)
        with closing(RobotClient(client)) as link, suppress(DeliveryError):
            link.deliver(data, unseal(data, source="m").hashes)
            link.order(sha256(data).hexdigest(), "start")
        thread.join(10)
    return True


def _relay(line: socket.socket, port: int, left: int, forward: bool) -> None:
    """Pass bytes on, over one or more connections, until so many have gone that way; then drop everything."""
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


def killed_agent(field: Field, data: bytes) -> bool:
    """Kill the agent at a random moment of an upload, or shortly after."""
    wait = field.rng.uniform(0.0, 0.5)
    kill = threading.Timer(wait, lambda: field.end(signal.SIGKILL))
    pace = field.rng.uniform(0.0, 0.2)
    with suppress(OSError), socket.create_connection(("127.0.0.1", field.port), timeout=5) as link:
        kill.start()
        link.sendall(head(data, len(data)))
        for k in range(0, len(data), 8192):
            link.sendall(data[k : k + 8192])
            time.sleep(pace / (len(data) / 8192))
        link.recv(4096)
    kill.join()
    field.begin()
    return True


def killed_sender(field: Field, data: bytes) -> bool:
    """Kill ``fieldhand send --start`` at a random moment; what it kept is sent later."""
    shutil.rmtree(field.folder / "outbox", ignore_errors=True)
    file = field.folder / "m.mission"
    file.write_bytes(data)
    command = [sys.executable, "-m", "fieldhand", "send", str(file), "--to", field.url, "--start"]
    sender = subprocess.Popen(command, env=field.env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    # Most of its time goes into starting; what counts is the moment at which it keeps the mission, and what follows.
    until = time.monotonic() + 60.0
    while sender.poll() is None and not (field.folder / "outbox").exists() and time.monotonic() < until:
        time.sleep(0.002)
    with suppress(subprocess.TimeoutExpired):
        sender.wait(field.rng.uniform(0.0, 0.8))
    sender.kill()
    sender.wait()
    pending = [sys.executable, "-m", "fieldhand", "send", "--pending"]
    subprocess.run(pending, env=field.env, capture_output=True, timeout=120, check=False)
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
    """What has to hold of the store of the agent at any time."""

    def __init__(self, field: Field) -> None:
        self.field = field
        self.whole: dict[str, bytes] = {}
        self.allowed: set[str] = set()

    def look(self) -> list[str]:
        """What is wrong in the store."""
        store, wrong = self.field.folder / "store", list[str]()
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


def transfer(field: Field, judge: Judge, kind: str, waiting: str, before: bytes | None) -> tuple[list[str], bool]:
    """Break one transfer, judge it, then deliver it for good.

    Returns:
        What was wrong, and whether the mission had arrived in spite of all.
    """
    data = field.bundle()
    name = sha256(data).hexdigest()
    judge.whole[name] = data
    may_start = BREAK[kind](field, data)
    if may_start:
        judge.allowed.add(name)
    with closing(field.link()) as link:
        arrived = link.mission(name)
        wrong = judge.look()
        if arrived is not None and not may_start:
            wrong.append(f"{kind}: a broken upload is there")
        held = link.mission(waiting)
        if held is None or held.mission.state != "waiting":
            wrong.append("the mission that waits does not wait any more")
        if before is not None:
            again = link.deliver(before, unseal(before, source="m").hashes)
            state = link.order(again.mission.bundle, "start").mission
            if again.new or state.state != "ended":
                wrong.append(f"a mission that has run is {state.state} after it was sent again")
        judge.allowed.add(name)
        link.deliver(data, unseal(data, source="m").hashes)
        link.order(name, "start")
        for _ in range(2400):
            stands = link.events(name, 0, 0.2)
            if stands.idle and stands.mission.state == "ended":
                break
            if stands.mission.state == "interrupted" and stands.idle:
                link.order(name, "resume")
        else:
            wrong.append(f"mission {name[:16]} does not end: {stands.mission}")
        if stands.mission.status != "completed":
            wrong.append(f"mission {name[:16]} ended {stands.mission.status}")
    return wrong + judge.look(), arrived is not None


def main() -> None:
    """Break transfers and count."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--transfers", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="only these")
    given = parser.parse_args()
    rng = random.Random(given.seed)
    broken, arrived, wrong = Counter[str](), Counter[str](), list[str]()
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        field = Field(Path(folder), rng)
        judge = Judge(field)
        field.begin()
        try:
            old = field.bundle()
            waiting = sha256(old).hexdigest()
            judge.whole[waiting] = old
            with closing(field.link()) as link:
                link.deliver(old, unseal(old, source="m").hashes)
            before: bytes | None = None
            for number in range(1, given.transfers + 1):
                kind = rng.choice(given.kinds)
                found, came = transfer(field, judge, kind, waiting, before)
                broken[kind] += 1
                arrived[kind] += came
                wrong += [f"transfer {number}, {kind}: {one}" for one in found]
                before = judge.whole[list(judge.whole)[-1]]
                if number % 20 == 0:
                    print(f"{number} transfers, {len(wrong)} wrong, {time.monotonic() - begun:.0f} s", flush=True)
        finally:
            field.end()
    for line in wrong:
        print(line)
    print(f"\n{'broken by':<15}{'transfers':>10}{'had arrived all the same':>26}")
    for kind in KINDS:
        print(f"{kind:<15}{broken[kind]:>10}{arrived[kind]:>26}")
    print(f"{sum(broken.values())} broken transfers, {len(wrong)} wrong, in {time.monotonic() - begun:.0f} s")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
