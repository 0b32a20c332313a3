"""The page in a browser: what a person sees and does, on a phone and on a large screen.

A test fails if the page asks another server for anything, breaks its own security policy, or has an error.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from support.processes.page_server import PageServer

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

CHROMIUM = shutil.which("chromium")
AXE = Path(__file__).parents[2] / "src/fieldhand/web/ui/node_modules/axe-core/axe.min.js"
pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed here"),
    pytest.mark.skipif(find_spec("playwright") is None, reason="the package playwright is not installed here"),
    pytest.mark.skipif(not AXE.is_file(), reason="the packages of the page are not installed here"),
]

#: Milliseconds within which the page does anything that it does at all, on a busy machine.
PATIENCE_MS = 180_000
PHONE, SCREEN = (390, 844), (1400, 900)
REQUEST = "Measure CO2 at the four corner trees. If it is low, take 2 pictures of nearby trees."
#: The page asks once whether the server has accounts and missions; the browser reports a 404 as an error.
_ASKED = re.compile(r"/api/v1/(session|missions)(\?.*)?$")


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageServer]:
    own = PageServer(tmp_path_factory.mktemp("server"))
    own.start()
    yield own
    own.stop()


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        # Without a sandbox: root has none, and the only pages that are opened are ours.
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def login(chromium: Browser, server: PageServer) -> Any:
    """Cookies of a session, where the server asks for one."""
    context = chromium.new_context()
    page = context.new_page()
    page.goto(server.link)
    page.locator(".example").first.wait_for(timeout=PATIENCE_MS)
    state = context.storage_state()
    context.close()
    return {**state, "origins": []}


@contextmanager
def opened(
    chromium: Browser, server: PageServer, login: Any, size: tuple[int, int] = PHONE, path: str = "/", **options: Any
) -> Iterator[Page]:
    """Open the page in a new profile; fail at the end if it asked another server, or had an error."""
    given: dict[str, Any] = {"locale": "en-US", "reduced_motion": "reduce", **options}
    context = chromium.new_context(storage_state=login, viewport={"width": size[0], "height": size[1]}, **given)
    context.set_default_timeout(PATIENCE_MS)
    faults: list[str] = []
    page = context.new_page()
    # Chromium's own scheme of addresses made by the page, for downloads, is no request to anyone.
    page.on("request", lambda r: None if r.url.startswith((server.url, "blob:")) else faults.append(f"asked {r.url}"))
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda line: _note(line, faults))
    page.goto(server.url + path)
    yield page
    context.close()
    assert not faults


def _note(line: Any, faults: list[str]) -> None:
    where = line.location.get("url", "")
    lost = "net::ERR_" in line.text  # a server that was stopped
    if line.type in ("error", "warning") and not lost and not _ASKED.search(where):
        faults.append(f"{line.text} ({where})")


def plan(page: Page, request: str) -> None:
    page.get_by_role("textbox", name="What should the robot do?").fill(request)
    page.get_by_role("button", name="Plan", exact=True).click()


def approve(page: Page) -> None:
    """Approve what was planned, and wait until it was simulated."""
    name, speed = page.get_by_label("Your name"), page.get_by_label("Speed of the simulation")
    if name.is_visible():
        name.fill("Ana")
    page.locator(".approve summary").click()
    if speed.is_visible():
        speed.select_option("max")
    page.get_by_role("button", name="Approve and simulate").click()
    page.locator(".run .goals").wait_for()


def accessibility_faults(page: Page) -> list[str]:
    """Return what axe-core calls serious or critical."""
    # Read from the disk and evaluated: the page's policy allows no script of another origin.
    found = page.evaluate(f"async () => {{ {AXE.read_text()}; return (await axe.run()).violations; }}")
    return [
        f"{fault['id']}: {node['html'][:200]}"
        for fault in found
        if fault["impact"] in ("serious", "critical")
        for node in fault["nodes"]
    ]


def small_targets(page: Page) -> list[str]:
    """Return the controls that a finger may miss: under 44 px, except those within a sentence."""
    return page.evaluate(  # type: ignore[no-any-return]
        """() => [...document.querySelectorAll('button, input, select, textarea, a, summary')]
            .filter((control) => !control.matches('.word, [type=range]'))
            .map((control) => control.closest('.tick') ?? control)
            .filter((box) => !box.classList.contains('skip') && box.checkVisibility())
            .map((box) => [box.outerHTML.slice(0, 90), box.getBoundingClientRect()])
            .filter(([, { width, height }]) => width < 44 || height < 44)
            .map(([html, { width, height }]) => `${html} ${width} x ${height}`)"""
    )


def checked(page: Page) -> None:
    """Hold the rules that are the same for every page."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the screen"
    assert not small_targets(page)
    assert not accessibility_faults(page)


@pytest.mark.parametrize(("size", "scheme"), [(PHONE, "light"), (SCREEN, "dark")])
def test_a_request_is_planned_approved_and_simulated(
    chromium: Browser, server: PageServer, login: Any, size: tuple[int, int], scheme: str
) -> None:
    with opened(chromium, server, login, size, color_scheme=scheme) as page:
        page.locator(".example").first.wait_for()
        checked(page)
        plan(page, REQUEST)
        page.get_by_role("heading", name="The plan").wait_for()
        assert "12 captures" in page.locator(".forecast").inner_text()
        # A place that is touched is pointed at on the map.
        before = page.locator("canvas.plan").evaluate("(canvas) => canvas.toDataURL()")
        page.get_by_role("button", name="four corner trees", exact=True).hover()
        page.wait_for_function("(before) => document.querySelector('canvas.plan').toDataURL() !== before", arg=before)
        approve(page)
        assert page.locator(".goals .success").count() == page.locator(".goals li").count() > 0
        page.get_by_label("Colour the map by").select_option("co2")
        page.locator(".chart canvas").wait_for()
        assert page.locator(".captures tbody tr").count() > 4
        page.get_by_label("Time in the mission").fill("0")
        assert page.locator(".time").inner_text().startswith("0:00 /")
        checked(page)
        with page.expect_download() as download:
            page.get_by_text("observations.csv").click()
        lines = Path(download.value.path()).read_text().splitlines()
        assert {"lat", "lon"} <= set(lines[0].split(","))
        assert len(lines) > page.locator(".captures tbody tr").count()


def test_a_question_is_answered_by_a_button(chromium: Browser, server: PageServer, login: Any) -> None:
    with opened(chromium, server, login, path="/#/ask/site/vineyard") as page:
        page.locator(".example").first.wait_for()
        plan(page, "Photograph row 15.")
        page.get_by_role("heading", name="A question first").wait_for()
        checked(page)
        page.locator(".choice").nth(1).click()
        page.get_by_role("heading", name="The plan").wait_for()
        assert "South" in page.locator(".steps").inner_text()


def test_what_is_not_understood_is_marked_and_another_request_offered(
    chromium: Browser, server: PageServer, login: Any
) -> None:
    with opened(chromium, server, login) as page:
        page.locator(".example").first.wait_for()
        plan(page, "Spray the oldest trees")
        page.get_by_role("heading", name="Not understood").wait_for()
        assert page.locator("mark").inner_text() == "Spray"
        instead = page.locator(".instead .example")
        text = instead.inner_text()
        instead.click()
        assert page.get_by_role("textbox", name="What should the robot do?").input_value() == text


def test_words_plan_and_view_survive_a_restart_and_open_without_the_server(
    chromium: Browser, server: PageServer, login: Any
) -> None:
    with opened(chromium, server, login) as page:
        page.locator(".example").first.wait_for()
        plan(page, "Take pictures of the 5 oldest trees.")
        page.get_by_role("heading", name="The plan").wait_for()
        page.get_by_role("button", name="Zoom in").click()
        page.evaluate("navigator.serviceWorker.ready.then(() => undefined)")
        view = page.evaluate("localStorage.getItem('fieldhand.view.demo')")
        assert view != "null"
        server.stop()
        try:
            page.get_by_text("No connection to the server").wait_for()
            page.reload()
            page.get_by_role("heading", name="The plan").wait_for()
            assert (
                page.get_by_role("textbox", name="What should the robot do?").input_value()
                == "Take pictures of the 5 oldest trees."
            )
            assert page.evaluate("localStorage.getItem('fieldhand.view.demo')") == view
            page.get_by_text("No connection to the server").wait_for()
            checked(page)
            # What is asked meanwhile is not sent, and that is said.
            page.get_by_label("Your name").fill("Ana")
            page.get_by_role("button", name="Approve and simulate").click()
            page.get_by_text("The server does not answer.").wait_for()
        finally:
            server.start()
        page.get_by_text("No connection to the server").wait_for(state="detached")


def test_a_table_of_plants_becomes_a_site_with_its_rows(
    chromium: Browser, server: PageServer, login: Any, tmp_path: Path
) -> None:
    rows = [f"{r}-{k},{48 + 2e-5 * k},{8 + 6e-5 * r},=1+{r}" for r in range(4) for k in range(12)]
    table = tmp_path / "orchard.csv"
    table.write_text("\n".join(["id,latitude,longitude,note", *rows]))
    with opened(chromium, server, login, SCREEN, path="/#/sites") as page:
        page.locator(".list .row").first.wait_for()
        page.get_by_label("Add a site from a file").set_input_files(table)
        page.get_by_role("heading", name="orchard", exact=True).wait_for()
        assert "4" in page.locator("table").first.inner_text()
        assert "found from the plants" in page.locator("table").first.inner_text()
        checked(page)
        page.get_by_role("button", name="Ask on this site").click()
        page.wait_for_function("() => document.querySelector('#site').selectedOptions[0]?.text === 'orchard'")
        plan(page, "Take a picture of every tree in row 2.")
        page.get_by_role("heading", name="The plan").wait_for()


def test_robots_say_what_they_can_do_in_spanish(chromium: Browser, server: PageServer, login: Any) -> None:
    with opened(chromium, server, login, path="/#/robots", locale="es-ES") as page:
        page.locator(".actions").first.wait_for()
        assert page.locator("html").get_attribute("lang") == "es"
        assert page.get_by_role("link", name="Fincas").is_visible()
        checked(page)
        page.get_by_label("Idioma").select_option("en")
        page.get_by_role("link", name="Sites").wait_for()


def begin_mission(page: Page, request_: str) -> None:
    """Plan a request, approve it, and wait until a simulated robot carries it out at its own speed."""
    page.locator(".example").first.wait_for()
    if not page.get_by_role("link", name="Missions").is_visible():
        pytest.skip("this server carries out no missions itself")
    plan(page, request_)
    page.locator(".approve summary").click()
    page.get_by_label("Speed of the simulation").select_option("1")
    if page.get_by_label("Your name").is_visible():
        page.get_by_label("Your name").fill("Ana")
    page.get_by_role("button", name="Approve and simulate").click()
    page.locator(".chip.running").wait_for()


def test_a_live_mission_is_followed_paused_and_stopped(chromium: Browser, server: PageServer, login: Any) -> None:
    with opened(chromium, server, login) as page:
        begin_mission(page, "Take a picture of every tree in row 3.")
        checked(page)
        page.get_by_role("button", name="Pause").click()
        page.get_by_text("The robot has received: Pause.").wait_for()
        page.locator(".chip.paused").wait_for()
        # One touch does not abort; the second does, within seconds, which a busy machine may take for a click.
        twice = "button => { button.click(); const asked = button.textContent; button.click(); return asked; }"
        assert "Really?" in page.get_by_role("button", name="Stop here").evaluate(twice)
        page.locator(".chip.aborted").wait_for()
        page.locator(".run.failure").wait_for()
        checked(page)
        page.get_by_role("link", name="Missions").first.click()
        assert page.locator(".list .chip").first.inner_text() == "stopped"
        checked(page)


def test_a_lost_server_makes_the_robots_position_old(chromium: Browser, server: PageServer, login: Any) -> None:
    with opened(chromium, server, login, SCREEN) as page:
        begin_mission(page, "Take a picture of every tree in row 4.")
        page.wait_for_function("() => document.querySelectorAll('.events li').length > 1")
        server.stop()
        try:
            page.get_by_text("No connection to the server").wait_for()
            page.get_by_text(re.compile(r"The position of the robot is \d+ s old")).wait_for()
            page.get_by_role("button", name="Pause").click()
            page.get_by_text("Not sent: Pause.").wait_for()
        finally:
            server.start()
        page.get_by_text("No connection to the server").wait_for(state="detached")
        page.get_by_text("The position of the robot is").wait_for(state="detached")
        page.get_by_role("button", name="Stop here").click()
        page.get_by_role("button", name="Really?").click()
        page.locator(".run.failure").wait_for()
