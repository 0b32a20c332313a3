// Log in with a name and a password.

import { t } from "../lang";
import { el, field, replace } from "../lib/dom";
import { problemNotice } from "../lib/problems";
import { session } from "../lib/session";

export function loginPage(entered: () => void): HTMLElement {
  const name = el("input", { autocomplete: "username", maxlength: 100, required: true, autocapitalize: "none" });
  const password = el("input", { type: "password", autocomplete: "current-password", maxlength: 1000, required: true });
  const button = el("button", { class: "main", type: "submit" }, t("log_in"));
  const place = el("div", { role: "alert" });
  const submit = async (event: Event) => {
    event.preventDefault();
    button.disabled = true;
    replace(place);
    try {
      await session.enter(name.value.trim(), password.value);
      entered();
    } catch (problem) {
      replace(place, problemNotice(problem));
    } finally {
      button.disabled = false;
    }
  };
  return el(
    "main",
    { class: "page login" },
    el("section", { class: "card", "aria-labelledby": "login-title" }, el("h2", { id: "login-title" }, t("log_in")), el("form", { onsubmit: submit }, field(t("name"), name), field(t("password"), password), button, place), el("p", { class: "hint" }, t("login_hint"))),
  );
}
