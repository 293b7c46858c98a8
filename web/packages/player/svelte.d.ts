// `import "@pantin/player/svelte"` defines the element, and lets templates of Svelte 4 and 5 have it.
import type { HTMLAttributes } from "svelte/elements";
import type { PantinPlayer, PantinPlayerAttributes, PantinPlayerListeners } from "@pantin/player";

export * from "@pantin/player";

type Own = PantinPlayerAttributes & PantinPlayerListeners;

declare module "svelte/elements" {
  interface SvelteHTMLElements {
    "pantin-player": Omit<HTMLAttributes<PantinPlayer>, keyof Own> & Own;
  }
}
