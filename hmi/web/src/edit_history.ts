/** A value with undo and redo. */
export class EditHistory<T> {
  private past: T[] = [];
  private future: T[] = [];
  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }
  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }
  change(next: T): void {
    this.past.push(this.current);
    this.future = [];
    this.current = next;
  }
  undo(): void {
    const earlier = this.past.pop();
    if (earlier === undefined) return;
    this.future.push(this.current);
    this.current = earlier;
  }
  redo(): void {
    const later = this.future.pop();
    if (later === undefined) return;
    this.past.push(this.current);
    this.current = later;
  }
}
