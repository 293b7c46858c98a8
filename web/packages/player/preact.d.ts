// `import "@pantin/player/preact"` defines the element, and lets JSX of Preact have it.
import type { HTMLAttributes } from "preact";
import type { PantinPlayer, PantinPlayerAttributes, PantinPlayerListeners } from "@pantin/player";

export * from "@pantin/player";

type Own = PantinPlayerAttributes & PantinPlayerListeners;

declare module "preact" {
  namespace JSX {
    interface IntrinsicElements {
      "pantin-player": Omit<HTMLAttributes<PantinPlayer>, keyof Own> & Own;
    }
  }
}
