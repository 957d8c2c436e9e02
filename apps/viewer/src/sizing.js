// Drawings follow the width they have; on paper they get one of their own, so that words keep the size of words.

/**
 * @param {Element} element whose width counts
 * @param {number} paper_width in CSS pixels
 * @param {(width: number) => void} resize
 */
export function keep_sized(element, paper_width, resize) {
    let width = 0, is_printing = false;
    new ResizeObserver(([entry]) => {
        const next = Math.round(entry.contentRect.width);
        if (!is_printing && next > 0 && next !== width) {
            width = next;
            resize(width);
        }
    }).observe(element);
    addEventListener("beforeprint", () => {
        is_printing = true;
        resize(paper_width);
    });
    addEventListener("afterprint", () => {
        is_printing = false;
        if (width > 0) {
            resize(width);
        }
    });
}
