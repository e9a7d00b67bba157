import { useEffect, useRef, useState } from 'preact/hooks';
import type { RefObject } from 'preact';

export const FONT = 'system-ui, sans-serif';

/** The width of an element in pixels of the page, kept up to date; 0 before it is known. */
export function useWidth(element: RefObject<HTMLElement>): number {
  const [width, setWidth] = useState(0);
  useEffect(() => {
    setWidth(element.current!.clientWidth);
    const observer = new ResizeObserver(() => element.current && setWidth(element.current.clientWidth));
    observer.observe(element.current!);
    return () => observer.disconnect();
  }, []);
  return width;
}

/** A canvas of `width` x `height` pixels of the page that is painted whenever something of `state` changes. */
export function useCanvas(width: number, height: number, paint: (context: CanvasRenderingContext2D) => void, state: unknown[]): RefObject<HTMLCanvasElement> {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (!canvas.current || width === 0) return;
    const ratio = devicePixelRatio;
    canvas.current.width = Math.round(width * ratio);
    canvas.current.height = Math.round(height * ratio);
    const context = canvas.current.getContext('2d')!;
    context.scale(ratio, ratio);
    paint(context);
  }, [width, height, ...state]);
  return canvas;
}
