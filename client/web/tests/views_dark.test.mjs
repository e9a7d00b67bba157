// Every view in the dark theme.
import { testViews } from './views.mjs';

testViews('dark');
