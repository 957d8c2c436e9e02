// A command to be copied.

import {foreign, h} from "./dom.js";

/** Copying by the clipboard where a page from a file may, else by a selection. */
async function copy(text, source) {
    try {
        await navigator.clipboard.writeText(text);
        return true;
    } catch {
        const range = document.createRange();
        range.selectNodeContents(source);
        getSelection().removeAllRanges();
        getSelection().addRange(range);
        return document.execCommand("copy");
    }
}

export function make_command(command) {
    const code = h("code", null, foreign(command));
    const status = h("span", {class: "muted", role: "status"});
    const button =
        h("button", {
            type: "button",
            class: "screen-only",
            onclick: async () => {
                status.textContent = (await copy(command, code)) ? "Copied." : "Selected: copy it with the keyboard.";
            }
        },
          "Copy");
    return h(
        "div", {class: "command"}, h("pre", {tabindex: "0", role: "region", "aria-label": "Command"}, code), button,
        status);
}
