// Light or dark: as the system says, until the reader says otherwise.

import {h} from "./dom.js";

const system = matchMedia("(prefers-color-scheme: dark)");

export function make_theme_switch() {
    let chosen = "auto";
    const followers = [];
    const apply = () => {
        const theme = chosen === "auto" ? (system.matches ? "dark" : "light") : chosen;
        document.documentElement.dataset.theme = theme;
        followers.forEach((follow) => follow(theme));
    };
    system.addEventListener("change", apply);
    apply();
    const choice = (value, text) =>
        h("label", null, h("input", {
              type: "radio",
              name: "theme",
              value,
              checked: value === chosen,
              onchange: () => {
                  chosen = value;
                  apply();
              }
          }),
          h("span", null, text));
    return {
        element:
            h("fieldset", {class: "theme screen-only"}, h("legend", {class: "visually-hidden"}, "Colours"),
              choice("auto", "Auto"), choice("light", "Light"), choice("dark", "Dark")),
        follow: (follow) => followers.push(follow),
    };
}
