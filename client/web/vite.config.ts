import { defineConfig } from 'vite';

// The dashboard is served by tribodynd alone: no addresses outside, no inline scripts, no source
// maps of what is public anyway.
export default defineConfig({
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 200,
  },
});
