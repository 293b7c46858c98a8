// `import "@pantin/player/vue"` defines the element, and lets templates of Vue have it; `compilerOptions.isCustomElement` names it to Vue's compiler.
import type { HTMLAttributes, Ref } from "vue";
import type { PantinPlayer, PantinPlayerAttributes, PantinPlayerListeners } from "@pantin/player";

export * from "@pantin/player";

// `@ended` is the property `onEnded`.
type Listeners = { [Name in keyof PantinPlayerListeners as Name extends `on${infer Event}` ? `on${Capitalize<Event>}` : never]: PantinPlayerListeners[Name] };
type Own = PantinPlayerAttributes & Listeners;
type Props = Omit<HTMLAttributes, keyof Own> & Own & { ref?: string | Ref<PantinPlayer | null> | ((element: unknown) => void) };

declare module "vue" {
  interface GlobalComponents {
    "pantin-player": new () => { $props: Props };
  }
}
