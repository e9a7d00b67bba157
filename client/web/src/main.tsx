import { render } from 'preact';
import './charts/theme';
import './style.css';
import { Shell } from './components/shell';

render(<Shell />, document.getElementById('app')!);
