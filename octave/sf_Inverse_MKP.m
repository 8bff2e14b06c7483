% SF_INVERSE_MKP  Invert a hysteresis model exactly: wanted displacement to temperature, say.
%
%   X = SF_INVERSE_MKP(FILE, Y) reads the model file FILE and gives the inputs X that make the
%   outputs Y, sample by sample, from where the model starts. X has the shape of Y.
%
%   [X, STATUS] = ... also says where X gives Y (int8): 0 it does, -1 below and 1 above every output
%   of the model, 2 within a jump of a relay model, 3 not in this sample: X is at an end of its
%   range, or a stage is too slow.
%
%   X = SF_INVERSE_MKP(..., NAME, VALUE, ...) with the options
%       'policy'     'hold' (the default): the input rests while the target rests;
%                    'anticipate': the input crosses the dead band at once, to where the output
%                    starts to move the way that the target goes next. That way is looked up in Y;
%                    a block that gets one sample at a time needs 'heading'
%       'heading'    the way that the target goes next: 1 rises, -1 falls, 0 hold; one number for
%                    each target, or one for all
%       'tolerance'  reversals of Y up to this size are noise and not followed, in the output's
%                    unit; by default 0, with 'anticipate' 1 % of the model's range
%       'time'       the time of each sample in seconds, as for SF_MKP
%       'load'       the load of each sample, or one for all, of a model that depends on one
%       'start'      'fitted' (the default), 'off' or 'on': where a FILE starts
%       'drive_range'   the lowest and the highest X; by default that of the drives fitted, of a
%                    model with a thermal body, and no limits of others
%       'horizon'    seconds in which a thermal body reaches the temperature it needs; by default
%                    one sample. Longer, noise of Y moves X less, and the output follows late
%
%   B = SF_INVERSE_MKP('open', FILE) opens a block that remembers. X = SF_INVERSE_MKP(B, Y, ...)
%   goes on from its last state. 'open', 'reset', 'save', 'restore', 'info', 'temperature' and
%   'close' are those of SF_MKP; each function has blocks of its own.
%
%   A model with a weight below zero has no inverse: hysteron:negativeWeights.
%
%   Example
%       Y = 5 + 3 * sin((0:200) / 20);
%       T = sf_Inverse_MKP('spring.json', Y, 'policy', 'anticipate');
%       max(abs(sf_MKP('spring.json', T) - Y))
%
%   See also SF_MKP.
function varargout = sf_Inverse_MKP(varargin)
error('hysteron:notBuilt', ...
    'sf_Inverse_MKP is not built yet: run octave/build in a shell, or build_hysteron here');
end
